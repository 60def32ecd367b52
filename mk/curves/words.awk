# words.awk: functions that the scripts of mk/curves share; loaded with -f before one of them. CSV files have a
# header, and no field is quoted or contains a comma.

# Reads the header: at[NAME] becomes the number of the field with that name.
function header(    i) {
    sub(/\r$/, "")
    delete at
    for (i = 1; i <= NF; i++) { at[$i] = i }
}

# Returns the field NAME of this row.
function field(name) {
    if (!(name in at)) { wrong("there is no column " name) }
    return $(at[name])
}

function wrong(what) {
    print FILENAME ":" FNR ": error: " what > "/dev/stderr"
    failed = 1
    exit 1
}

# Removes a Windows line end from this row, and fails if the row has a quote.
function plain_row() {
    sub(/\r$/, "")
    if (/"/) { wrong("a quoted field") }
}

# Returns the scene of a command line.
function scene_of(run,    word) {
    split(run, word, " ")
    return word[3]
}

# Returns the setting in "whirl run SCENE ... --step S --until U", such as "--method rk4 --number float".
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

# Returns the number type of a setting, with the name that measure_one.sh uses.
function number_of(run) { return run ~ / --number / ? option_of(run, "--number") : "double" }

# Returns the options for `whirl derive`, with the step, but without the number type and the end. Fixed point needs
# the end, too, because its ranges are those of the motion until then.
function derive_options(run,    step, end) {
    step = option_of(run, "--step")
    end = number_of(run) == "fixed" ? " --until " option_of(run, "--until") : ""
    run = setting_of(run)
    sub(/ ?--number [^ ]*/, "", run)
    return run " --step " step end
}
