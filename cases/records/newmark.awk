# Newmark's (1965) rigid block under a record of two columns, t (s) and a (m/s2), linear between its rows:
#   awk -v ky=0.1 -v sign=-1 -f cases/records/newmark.awk RECORD
# It slides one way, while the ground goes faster than ky g along `sign` times the record, until it goes with the ground
# again. Prints its way, m, at the rows, as `bsmpm compare --reference` reads it. Steps of 10 us.
BEGIN { FS = ","; g = 9.81; h = 1e-5; print "x,y" }
/^[0-9]/ {
    n = int(($1 - t) / h + 0.5)
    for (i = 1; i <= n; i++) {
        excess = sign * (a + ($2 - a) * i / n) - ky * g
        v += excess * h
        if (v < 0) v = 0
        way += v * h
    }
    t = $1 + 0
    a = $2 + 0
    printf "%.2f,%.5f\n", t, way
}
