# turn_errors.awk: what turn_errors.sh prints as a table in Markdown.
NR == 1 {
    print "| scene | accelerations | float | float, compensated | double | drift, float | drift, double |"
    print "|---|---|---|---|---|---|---|"
    next
}
{
    setting = $2
    if (split(setting, part, "_") > 1) { setting = part[1] ", " part[2] " cells" }
    printf "| `%s` | %s | %s | %s | %s | %s | %s |\n", $1, setting, $3, $4, $5, $6, $7
}
