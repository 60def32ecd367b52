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
function row(peer, what) {
    printf "| %s | %s | %s | %s | %s |\n", title[peer], value[peer, "epicyclic", "instructions"],
        ratio(value[peer, "epicyclic", what]), value[peer, "thomson", "instructions"], ratio(value[peer, "thomson", what])
}
END {
    print "| | gear, instructions | gear, time | Thomson, instructions | Thomson, time |"
    print "|---|---|---|---|---|"
    for (i = 1; i in steps; i++) { row(steps[i], "ratio") }
    row("sympy", "derivation")
}
