# vcd_cart.awk: `awk -F, -v cart=N -f vcd_cart.awk carts.whirl ROWS`: the rows that vcd.awk made of a cart of vcd.sh, held against
# its motion. Columns: time, x, a, n, der(x), der(a), der(n), three outputs; then of both stops whether something rests there,
# how often it was hit, when last; whether the friction sticks; whether x is above the level, how often that was crossed,
# when last. Says how many hits there were, or what is wrong.
function wrong(what) {
    print "cart " cart ", row " FNR ": " what ": " $0
    bad = 1
    exit 1
}
function size(of) { return of < 0 ? -of : of }
# no force accelerates it by more than 25 m/s^2, so that 1 ms after a row it is within this of where it went, in m
BEGIN { dt = 1e-3; off_m = 25*dt*dt/2 + 3e-6; gain_mps = 25*dt }

FNR == NR && /^mechanism/ { on = index($0, "mechanism c" cart " ") == 1 }
FNR == NR && on && /^coordinate x/ { metre = /\[mm\]/ ? 1e-3 : /\[ft\]/ ? 0.3048 : 1 }
FNR == NR && on && /stop x/ { split($0, word, " "); if (word[3] == ">=") low = word[4] + 0; else high = word[4] + 0 }
FNR == NR && on && /when x/ { split($0, word, " "); level = word[4] + 0; way = word[6] == "{" ? "both" : word[6] }
FNR == NR { next }

{
    t = $1; x = $2*metre; v = $5*metre
    rests[1] = $11; rests[2] = $14; sticks = $17; above = $18; crossed = $19
    if (x < low - 1e-9 || x > high + 1e-9) wrong("beyond a stop")
    if ((sticks || rests[1] || rests[2]) && v != 0) wrong("moves though it sticks or rests")
    # what lets go just behind a row is told at its tick
    if (FNR > 1 && v == 0 && !(sticks || rests[1] || rests[2]) && !(was_sticks || was_rests[1] || was_rests[2])) wrong("stands though nothing keeps it")
    if ((rests[1] && size(x - low) > 1e-9) || (rests[2] && size(x - high) > 1e-9)) wrong("rests off the stop")
    if (size(x - level) > 1e-9 && above != (x > level)) wrong("on the other side")
    if ($4 != crossed) wrong("crossed " crossed " times, counted " $4)
}
FNR > 1 {
    hits[1] = $12 - was_hit[1]; hits[2] = $15 - was_hit[2]
    all += hits[1] + hits[2]
    if (size(v - was_v) > 2*gain_mps && hits[1] + hits[2] == 0) wrong("thrown back by nothing")
    for (i = 1; i <= 2; i++) {
        at = i == 1 ? $13 : $16
        place = i == 1 ? low : high
        away = i == 1 ? v : -v
        if (hits[i] == 1 && hits[3 - i] == 0) {
            if (was_rests[i]) wrong("hit by what rests there")
            if (at < was_t || at > t) wrong("hit at another time")
            if (size(was_x + was_v*(at - was_t) - place) > off_m) wrong("hit before it is there")
            if (away < -gain_mps) wrong("hit, and goes on")
        }
    }
    if (hits[1] + hits[2] == 0) {
        rises = was_x < level - 1e-9 && x > level + 1e-9
        falls = was_x > level + 1e-9 && x < level - 1e-9
        if ((rises && way != "falling" || falls && way != "rising") != crossed - was_crossed && size(was_x - level) > 1e-9 && size(x - level) > 1e-9 &&
            size(was_x - level) + size(x - level) > 2*off_m) wrong("not crossed, or for nothing")
        if (crossed > was_crossed && ($20 < was_t || $20 > t || size(was_x + was_v*($20 - was_t) - level) > off_m)) wrong("crossed before it is there")
    }
}
{ was_t = t; was_x = x; was_v = v; was_hit[1] = $12; was_hit[2] = $15; was_crossed = crossed; was_rests[1] = rests[1]; was_rests[2] = rests[2]; was_sticks = sticks }
END { if (!bad && FNR < 2000) wrong("no rows"); if (!bad) print all + 0 " hits"; exit bad }
