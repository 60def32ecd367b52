# choose_summary.awk: the last lines of choose_check.sh. Exit status 1 where something does not hold.
FILENAME ~ /answered$/ {
    answered++
    kept += $2 <= 1
    worst = $2 > worst ? $2 : worst
    beyond += $3 > 10 || $3 < -10
    off = $3 < 0 ? -$3 : $3
    most = off > most ? off : most
    if ($4 != "-") { ranges++; outside += $4 > 1 }
    bad += $NF != "yes"
    next
}
{
    none++
    bad += $2 != "yes"
    proved += $3 ~ /^proved/
    cautious += $3 ~ /^cautious/
}
END {
    printf "%d requests: %d answered, %d kept the error, the worst at %.3f of what was allowed; %d nothing fits, %d proved by trying all settings", \
        answered + none, answered, kept, worst, none, proved
    if (proved + cautious < none) { printf ", %d not", none - proved - cautious }
    if (cautious) { printf ", %d refused by the promises' bounds alone", cautious }
    printf "\nsteps: %d of %d promises beyond 10 %%, the largest %.1f %%", beyond, answered, most
    if (ranges) { printf "; between the places of %d ranges %d were beyond the error", ranges, outside }
    printf "\n%d do not hold\n", bad
    if (none < enough) { printf "only %d were answered by nothing fits, and %d are needed: another seed\n", none, enough; bad++ }
    exit bad > 0
}
