# decades.awk: the errors in the tables. Loaded with -f before one of the other scripts of mk/curves.

BEGIN { DECADES = 9 }

function decade(d) { return 10 ^ -d }

# such as 1e-3
function decade_words(d) { return sprintf("1e-%d", d) }

# such as 12.3k for 12345: three digits
function short(value,    unit, i) {
    unit = split("k M G T", units, " ")
    if (value < 999.5) { return sprintf("%.0f", value) }
    for (i = 0; value >= 999.5 && i < unit; i++) { value /= 1000 }
    return sprintf(value < 9.995 ? "%.2f" : value < 99.95 ? "%.1f" : "%.0f", value) units[i]
}

# such as 2.5 ms for 0.0025
function step_words(step) {
    return step >= 0.9999e-3 ? sprintf("%.4g ms", step * 1e3) : sprintf("%.4g us", step * 1e6)
}
