//! The last step's pore-water flow in a checkpoint.

use super::CrossedState;
use bsmpm::field::pore_water::crossed::PreviousFlow;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};

/// The last step's flow: its length in s, what crossed surfaces in it, and what it left out of balance, m3 per metre.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlowedState {
    #[serde(deserialize_with = "length")]
    dt: f64,
    crossed: CrossedState,
    left: f64,
}

impl FlowedState {
    pub(crate) fn of(PreviousFlow { dt, crossed, left }: &PreviousFlow) -> Self {
        Self {
            dt: *dt,
            crossed: CrossedState::of(crossed),
            left: *left,
        }
    }

    pub(super) fn flow(&self) -> PreviousFlow {
        PreviousFlow {
            dt: self.dt,
            crossed: self.crossed.volumes(),
            left: self.left,
        }
    }
}

/// The length of a step, s, of which there is more than none.
fn length<'de, From: Deserializer<'de>>(from: From) -> Result<f64, From::Error> {
    let dt = f64::deserialize(from)?;
    if dt > 0.0 {
        Ok(dt)
    } else {
        Err(From::Error::custom(format_args!("its last step of flow took {dt} s")))
    }
}

#[cfg(test)]
mod tests {
    use super::{FlowedState, PreviousFlow};

    #[test]
    fn a_step_of_flow_took_time() {
        let kept = |dt: f64| format!(r#"{{"dt":{dt},"crossed":{{"drains":[],"faces":[],"inflows":[]}},"left":0.0}}"#);
        let flow = serde_json::from_str::<FlowedState>(&kept(0.5)).unwrap().flow();
        assert_eq!(
            flow,
            PreviousFlow {
                dt: 0.5,
                ..PreviousFlow::default()
            }
        );
        let refused = serde_json::from_str::<FlowedState>(&kept(0.0)).unwrap_err();
        assert!(
            refused.to_string().contains("its last step of flow took 0 s"),
            "{refused}"
        );
    }
}
