# scenes.awk: of runs.sh's files of every scene, the cheapest rows of a few settings: docs/figures/price_scenes.csv.
#
#   awk -F, -v methods="M..." -f words.awk -f decades.awk -f scenes.awk OUT/SCENE.csv...
#
# The settings are the methods' in each number, in the default form. Within 1e-2, 1e-4, 1e-6 and 1e-8 a row each, where
# there is one; the prices are those on a Cortex-M4F, or evaluations of the accelerations where nobody knows these.

BEGIN { print "scene,price_of,per_s,error,component,step_s,method,number,run" }

FNR == 1 {
    header()
    scene = FILENAME
    sub(/.*\//, "", scene)
    sub(/\.csv$/, "", scene)
    next
}

{ plain_row() }

{
    own = setting_of(field("run"))
    sub(/ --number (float|fixed)/, "", own)
    sub(/ --compensated/, "", own)
    if (own != "--method " field("method") || index(" " methods " ", " " field("method") " ") == 0) { next }
    # by rising price
    take = 0
    for (d = 2; d <= 8; d += 2) {
        if (field("error") <= decade(d) && !((scene, d) in has)) { has[scene, d] = take = 1 }
    }
    if (take) {
        print scene, field("price_of"), sprintf("%.6g", field("price_per_s")), field("error"), field("component"), \
            field("step_s"), field("method"), field("number"), field("run")
    }
}
