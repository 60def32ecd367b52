# words.awk: what the scripts of mk/curves have in common, before one of them with -f: rows of CSV files with a header,
# no field of which is quoted or holds a comma.

# Reads the header: at[NAME] is the field of that name.
function header(    i) {
    sub(/\r$/, "")
    delete at
    for (i = 1; i <= NF; i++) { at[$i] = i }
}

# The field NAME of this row.
function field(name) {
    if (!(name in at)) { wrong("there is no column " name) }
    return $(at[name])
}

function wrong(what) {
    print FILENAME ":" FNR ": error: " what > "/dev/stderr"
    failed = 1
    exit 1
}

# A row of a file with Windows' ends and without quotes.
function plain_row() {
    sub(/\r$/, "")
    if (/"/) { wrong("a quoted field") }
}

# The scene of a command line.
function scene_of(run,    word) {
    split(run, word, " ")
    return word[3]
}

# What of a command line "whirl run SCENE ... --step S --until U" is the setting: "--method rk4 --number float".
function setting_of(run) {
    sub(/^whirl run [^ ]* /, "", run)
    sub(/ --step .*/, "", run)
    return run
}

function option_of(run, option) {
    if (!match(run, " " option " [^ ]*")) { return "" }
    run = substr(run, RSTART + 1, RLENGTH - 1)
    sub(/^[^ ]* /, "", run)
    return run
}

# The number that a setting computes in: what measure_one.sh calls it.
function number_of(run) { return run ~ / --number / ? option_of(run, "--number") : "double" }

# The options that `whirl derive` is given, with the step: no number, no end, but in fixed point, whose ranges are those of the
# motion to there.
function derive_options(run,    step, end) {
    step = option_of(run, "--step")
    end = number_of(run) == "fixed" ? " --until " option_of(run, "--until") : ""
    run = setting_of(run)
    sub(/ ?--number [^ ]*/, "", run)
    return run " --step " step end
}
