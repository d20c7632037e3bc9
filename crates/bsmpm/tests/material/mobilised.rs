//! Tests of mobilised strength against closed forms of the yield functions.

use super::mohr_coulomb;
use bsmpm::material::{Elastic, Material, VonMises};

#[test]
fn mobilised_strength_is_that_of_the_yield_function() {
    let close = |found: f64, exact: f64| assert!((found - exact).abs() < 1e-6, "{found} for {exact}");
    for (first, third) in [(-10.0, -20.0), (-5.0, -14.0), (-1.0, -1.1)] {
        let tau = [first, 0.3 * first + 0.7 * third, third];
        // Cohesion alone, friction alone (degrees), both.
        close(
            mohr_coulomb(1e3, 0.3, 0.0, 0.0, 8.0).mobilised(tau, &[]),
            (first - third) / 16.0,
        );
        let mobilised = ((first - third) / -(first + third)).asin().tan() / 30.0_f64.to_radians().tan();
        close(mohr_coulomb(1e3, 0.3, 30.0, 0.0, 0.0).mobilised(tau, &[]), mobilised);
        let both = mohr_coulomb(1e3, 0.3, 30.0, 0.0, 4.0);
        let share = both.mobilised(tau, &[]);
        assert!(both.reduced(1.0 / share).yield_function(tau, &[]).abs() < 1e-5);
    }
    let mises = Material::VonMises(VonMises::new(
        Elastic {
            young: 1e3,
            poisson: 0.3,
        },
        20.0,
        0.0,
    ));
    close(mises.mobilised([5.0, 0.0, 0.0], &[0.0]), 0.25);
    assert!(Material::is_yielding(mises.mobilised([20.0, 0.0, 0.0], &[0.0])) && !Material::is_yielding(0.99));
    // Nothing of pressure alone; what is beyond is reported, to an end.
    assert_eq!(mises.mobilised([-7.0; 3], &[0.0]), 0.0);
    close(mises.mobilised([60.0, 0.0, 0.0], &[0.0]), 3.0);
    assert_eq!(mohr_coulomb(1e3, 0.3, 30.0, 0.0, 1.0).mobilised([9.0; 3], &[]), 16.0);
    assert_eq!(super::hencky(1e3, 0.3).mobilised([9.0, 0.0, -9.0], &[]), 0.0);
}
