# pairs.awk: what is to be priced: every effect of every mechanism, and the ledger.
#
#   whirl list --as table FILE... | awk -f pairs.awk
#
# For each a line "N MECHANISM EFFECT KIND STEP_s UNTIL_s TARGET": TARGET is the first scene that calls for the effect,
# else the mechanism's first one; a mechanism without scenes has none. KIND is additive, contact, noise or ledger.
BEGIN { FS = "\t" }

$1 == "mechanism" { mechanisms[++count] = $4 ":" $3; name[count] = $3 }

$1 == "effect" {
    of = $4 ":" $3
    effects[of, ++effect_count[of]] = $2
    kind[of, $2] = $8 ~ /contacts/ ? "contact" : $8 ~ /noise/ ? "noise" : "additive"
}

$1 == "scene" {
    of = $4 ":" $3
    scenes[of, ++scene_count[of]] = $4 ":" $2
    calls[of, scene_count[of]] = "," $7 ","
    times[of, scene_count[of]] = $9 " " $10
}

function pair(of, name, effect, kind,    s, found) {
    found = scene_count[of] > 0 ? 1 : 0
    for (s = scene_count[of]; s > 0; s--) {
        if (index(calls[of, s], "," effect ",") > 0) {
            found = s
        }
    }
    if (found > 0) {
        print ++pairs, name, effect, kind, times[of, found], scenes[of, found]
    }
}

END {
    for (m = 1; m <= count; m++) {
        of = mechanisms[m]
        for (e = 1; e <= effect_count[of]; e++) {
            pair(of, name[m], effects[of, e], kind[of, effects[of, e]])
        }
        pair(of, name[m], "ledger", "ledger")
    }
}
