# table.awk: the rows of race.sh as a table of Markdown.
BEGIN {
    title["whirl"] = "Whirl, all coordinates integrated"
    title["plain"] = "plain C, by hand, libm"
    title["odeint"] = "odeint (Boost), `runge_kutta4`"
    title["gsl"] = "GSL, `gsl_odeiv2_step_rk4`"
    title["arkode"] = "ARKODE (SUNDIALS), `ARKStep`, classic tableau"
    title["octave"] = "Octave, a loop around the generated function"
    title["sympy"] = "SymPy, from the energies to C (`LagrangesMethod`, `cse`)"
    split("whirl plain odeint gsl arkode octave", steps, " ")
}
{ value[$1, $2, $3] = $4 }
function ratio(x) { return x == "" ? "" : sprintf(x < 10 ? "%.2f" : "%.0f", x) }
function row(peer, what,   i, line) {
    line = "| " title[peer]
    for (i = 1; i in systems; i++) {
        line = line " | " value[peer, systems[i], "instructions"] " | " ratio(value[peer, systems[i], what])
    }
    print line " |"
}
END {
    split("epicyclic thomson reduced", systems, " ")
    print "| | gear, instructions | gear, time | Thomson, instructions | Thomson, time | with addition theorems | time |"
    print "|---|---|---|---|---|---|---|"
    for (i = 1; i in steps; i++) { row(steps[i], "ratio") }
    row("sympy", "derivation")
}
