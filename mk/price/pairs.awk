# pairs.awk: what is to be priced: every effect of every mechanism of a .whirl file, and the ledger.
#
#   awk -v out=build/price -v first=12 -f pairs.awk core/models/x.whirl
#
# Reads the file and writes for each pair, numbered from `first`:
#   OUT/N.scenes  two scenes, N_without and N_with, to be put behind the file without its scenes: the state,
#                 step and parameters of the first scene that calls for the effect, else of the mechanism's
#                 first one
#   OUT/N.bare    N_without again, without the values it sets of effects' parameters: for a file without
#                 effects
# and a line "N MECHANISM EFFECT KIND STEP_s UNTIL_s FILE" for each to standard output; KIND is additive, hybrid,
# noise or ledger.

function seconds(line,    part) {
    split(line, part, /[ \t\[\]]+/)
    return part[3] * (line ~ /\[ms\]/ ? 1e-3 : line ~ /\[min\]/ ? 60 : 1)
}

# The assignments of a set line but those of names that other effects than `effect` own: a scene may set only what
# takes part in it.
function sets_of(line, effect,    part, count, i, kept, name) {
    sub(/^ *set */, "", line)
    sub(/ *#.*$/, "", line)
    count = split(line, part, /, */)
    kept = ""
    for (i = 1; i <= count; i++) {
        name = part[i]
        sub(/ *=.*/, "", name)
        if (!((mechanism_of_scene, name) in own) || own[mechanism_of_scene, name] == effect) {
            kept = kept (kept == "" ? "" : ", ") part[i]
        }
    }
    return kept == "" ? "" : "  set " kept
}

{ sub(/\r$/, "") }

$1 == "mechanism" {
    mechanism = $2
    mechanisms[++mechanism_count] = mechanism
}

$1 == "effect" {
    effect = $2
    inside = "effect"
    effects[mechanism, ++effect_count[mechanism]] = effect
    kind[mechanism, effect] = "additive"
}

inside == "effect" {
    if ($0 ~ /^ *(stop|friction|hold|when) / || $0 ~ /[{;] *(stop|friction|hold|when) /) {
        kind[mechanism, effect] = "hybrid"
    } else if ($0 ~ /^ *noise / && kind[mechanism, effect] != "hybrid") {
        kind[mechanism, effect] = "noise"
    }
    if ($1 == "parameter" || $1 == "input") {
        own[mechanism, $2] = effect
    }
    if (/^}/) {
        inside = ""
    }
}

$1 == "scene" {
    scene = $2
    scene_count++
    inside = "scene"
    use[scene_count] = mechanism
    body_lines[scene_count] = 0
    next
}

inside == "scene" {
    if (/^}/) {
        inside = ""
    } else if ($1 == "use") {
        use[scene_count] = $2
    } else if ($1 == "with") {
        line = $0
        sub(/#.*/, "", line)
        gsub(/,/, " ", line)
        with[scene_count] = with[scene_count] " " substr(line, index(line, "with") + 4) " "
    } else if ($1 != "conserve") {
        body[scene_count, ++body_lines[scene_count]] = $0
        if ($1 == "step") {
            step_s[scene_count] = seconds($0)
        } else if ($1 == "until") {
            until_s[scene_count] = seconds($0)
        }
    }
}

function write_scene(path, name, s, effect,    i, line) {
    print "scene " name " \"price\" {\n  use " use[s] >path
    if (effect != "") {
        print "  with " effect >path
    }
    mechanism_of_scene = use[s]
    for (i = 1; i <= body_lines[s]; i++) {
        line = body[s, i]
        if (line ~ /^ *set /) {
            line = sets_of(line, effect)
        }
        print line >path
    }
    print "}" >path
}

function pair(mechanism, effect, kind,    s, found) {
    found = 0
    for (s = 1; s <= scene_count && !found; s++) {
        found = use[s] == mechanism && index(with[s], " " effect " ") > 0 ? s : 0
    }
    for (s = 1; s <= scene_count && !found; s++) {
        found = use[s] == mechanism ? s : 0
    }
    if (found == 0) {
        return
    }
    write_scene(out "/" first ".scenes", "p" first "_without", found, "")
    write_scene(out "/" first ".scenes", "p" first "_with", found, effect)
    write_scene(out "/" first ".bare", "p" first "_without", found, "")
    close(out "/" first ".scenes")
    close(out "/" first ".bare")
    print first, mechanism, effect, kind, step_s[found], until_s[found], FILENAME
    first++
}

END {
    for (m = 1; m <= mechanism_count; m++) {
        for (e = 1; e <= effect_count[mechanisms[m]]; e++) {
            pair(mechanisms[m], effects[mechanisms[m], e],
                kind[mechanisms[m], effects[mechanisms[m], e]])
        }
        pair(mechanisms[m], "ledger", "ledger")
    }
}
