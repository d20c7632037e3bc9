# Makes cases/records/made.csv: awk -f cases/records/made.awk > cases/records/made.csv
# An accelerogram that is made, not recorded, and the same wherever it is made: noise with the spectrum of Kanai
# (1957) and Tajimi (1960), filtered below by Clough and Penzien (1975), as a sum of cosines of random phases
# (Shinozuka and Deodatis, 1991), under an envelope as Amin and Ang's (1968), whose phases are of Park and Miller's
# (1988) generator. What is left of its velocity is taken off with the envelope, and the largest acceleration is set.
function density(f,    r, s) {              # of firm ground, 2.5 Hz and .6 of critical; below .4 Hz it falls
    r = (f / 2.5) ^ 2
    s = (f / 0.4) ^ 2
    return (1 + 1.44 * r) / ((1 - r) ^ 2 + 1.44 * r) * s ^ 2 / ((1 - s) ^ 2 + 1.44 * s)
}
function envelope(t) {                      # rises over 1.5 s, stays for 4 s, fades
    if (t < 1.5) return (t / 1.5) ^ 2
    if (t < 5.5) return 1
    return t < 10 ? exp(-0.9 * (t - 5.5)) * (10 - t) / 4.5 : 0
}
BEGIN {
    pi = atan2(0, -1)
    seed = 22
    peak = -3.5                             # m/s2, of the greatest one
    dt = 0.01
    rows = 1000
    waves = 240
    step = 0.05                             # Hz: it repeats itself after 20 s
    for (k = 1; k <= waves; k++) {
        seed = (16807 * seed) % 2147483647
        phase[k] = 2 * pi * seed / 2147483647
        size[k] = sqrt(density(k * step))
    }
    for (row = 0; row <= rows; row++) {
        t = row * dt
        for (k = 1; k <= waves; k++) a[row] += size[k] * cos(2 * pi * k * step * t + phase[k])
        a[row] *= envelope(t)
        moved += a[row]
        whole += envelope(t)
    }
    for (row = 0; row <= rows; row++) {
        a[row] -= moved / whole * envelope(row * dt)
        size_of = a[row] < 0 ? -a[row] : a[row]
        if (size_of > largest) largest = size_of
    }
    print "# Made, not recorded, by made.awk: noise of firm ground, up to 3.5 m/s2, positive along x"
    print "t [s], a [m/s2]"
    for (row = 1; row <= rows; row++) printf "%.2f, %.4f\n", row * dt, a[row] * peak / largest
}
