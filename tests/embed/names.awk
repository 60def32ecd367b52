# names.awk: a mechanism with awkward names and texts, and checks of its generated header.
#
#     awk -v seed=N -v number=I -v folder=FOLDER -f names.awk
#
# writes FOLDER/I.whirl with one scene, and FOLDER/I.checks: lines of C that hold after wh_scene_start().

function one_of(list, parts, n) {
    n = split(list, parts, " ")
    return parts[1 + int(n * rand())]
}

# A name that this mechanism does not have yet.
function fresh(name) {
    do
        name = one_of(names)
    while (name in taken)
    taken[name] = 1
    return name
}

function text() {
    return texts[1 + int(text_count * rand())]
}

function check(line) {
    print "    CHECK(" line ");" >checks
}

# Writes a check: component `name` with `primes` primes, in `unit`, starts at `value` in state.real[SCENE_KIND_NAME].
function check_real(kind, name, primes, value, unit) {
    check("state.real[" scene "_" kind "_" name "] == WH_R(" value ")")
    check("same(of_reals[" scene "_" kind "_" name "], \"" name primes "\")")
    check("same(in_reals[" scene "_" kind "_" name "], \"" unit "\")")
}

BEGIN {
    srand(seed * 1000 + number)
    names = "x X x_ _x __x x__x theta Theta THETA class new delete int double template this operator and not xor " \
        "register main bool true NULL EOF errno signed union struct linux unix INPUT OUTPUT PI EULER HIGH A0 B1 " \
        "RATE RATE_x RATE2 RATE2_x REAL REAL_x ANGLE ANGLE_x ANGLES REALS INPUTS OUTPUTS OUTPUT_x OUTPUTRATE INPUT_x " \
        "NAMES_OF_REALS UNITS_OF_REALS NAMES UNITS MEMORY MEMORY_BYTES MEMORY_WORDS CONTACTS ACCOUNTS H " \
        "real angle linear rate model phase result observe advance accelerations contacts ledger x1 s1 c1 " \
        "wh_x WH_R wh_real a_very_long_name_of_sixty_three_characters_which_is_the_most_of"
    text_count = split("plain|*/ int boom; /*|ends in a backslash \\|what??/|//* not a comment|\316\270 is Greek|" \
        "turned \342\200\256 round|100 %s %d|*|/|\302\240", texts, "|")
    file = folder "/" number ".whirl"
    checks = folder "/" number ".checks"
    scene = one_of("a A a_ a_RATE a_OUTPUT INPUT x class_ s") "_" number
    third = number % 3 == 2 # every third is a system of equations, of third order

    print "mechanism m" number " \"" text() "\"" >file
    lengths = third ? 1 : 1 + int(3 * rand())
    turns = third ? 0 : int(3 * rand())
    given = 1 + int(2 * rand())
    shown = 1 + int(3 * rand())
    for (i = 1; i <= lengths; i++)
        x[i] = fresh()
    for (i = 1; i <= turns; i++)
        a[i] = fresh()
    for (i = 1; i <= given; i++)
        u[i] = fresh()
    for (i = 1; i <= shown; i++)
        o[i] = fresh()
    for (i = 1; i <= lengths; i++)
        print (third ? "state " : "coordinate ") x[i] " [mm] \"" text() "\"" >file
    for (i = 1; i <= turns; i++)
        print "coordinate " a[i] " [deg] \"" text() "\"" >file
    for (i = 1; i <= given; i++)
        print "input " u[i] " = " i ".25 [N] \"" text() "\"" >file
    if (third) {
        print "equation " x[1] "''' = (" u[1] (given > 1 ? " + " u[2] : "") ")/(2 [kg])/(1 [s]) - " x[1] "/(1 [s^3])" >file
    } else {
        energy = "2 [kg]*" x[1] "'^2/2"
        for (i = 2; i <= lengths; i++)
            energy = energy " + 3 [kg]*" x[i] "'^2/2"
        for (i = 1; i <= turns; i++)
            energy = energy " + 0.5 [kg*m^2]*" a[i] "'^2/2"
        print "T = " energy >file
        print "V = 4 [N/m]*" x[1] "^2/2" (turns > 0 ? " - 3 [J]*cos(" a[1] ")" : "") (turns > 1 ? " - 1 [J]*cos(" a[2] ")" : "") >file
        print "Q(" x[1] ") = " u[1] (given > 1 ? " + " u[2] : "") >file
        if (number % 2 == 1)
            print "stop " x[1] " >= -5 [m] restitution 0.5" >file
        else if (lengths > 1) # the state has the value that this hold keeps
            print "hold " x[1] " + " x[2] " while " x[1] " > 5 [m]" >file
    }
    for (i = 1; i <= shown; i++)
        print "output " o[i] " [mm] = " x[1] " + " i " [m]" >file

    conserved = !third && lengths > 1 && number % 4 == 3
    starts = ""
    reals = 0
    for (i = 1; i <= lengths; i++) {
        if (conserved && i == lengths) {
            starts = starts ", " x[i] " = 7 [m], " x[i] "' = 8 [m/s]"
            check("output[" scene "_OUTPUT_" x[i] "] == WH_R(7.0)")
            check("output[" scene "_OUTPUTRATE_" x[i] "] == WH_R(8.0)")
            check("same(in_outputs[" scene "_OUTPUTRATE_" x[i] "], \"m/s\")")
            continue
        }
        starts = starts ", " x[i] " = " i ".5 [m], " x[i] "' = " i ".125 [m/s]"
        check_real("REAL", x[i], "", i ".5", "m")
        check_real("RATE", x[i], "'", i ".125", "m/s")
        reals += 2
    }
    if (third) {
        starts = starts ", " x[1] "'' = 9.5 [m/s^2]"
        check_real("RATE2", x[1], "''", "9.5", "m/s^2")
        reals++
    }
    for (i = 1; i <= turns; i++) {
        starts = starts ", " a[i] " = " i ".75 [rad], " a[i] "' = " i ".375 [rad/s]"
        check("near(wh_angle_to_rad(state.angle[" scene "_ANGLE_" a[i] "]), WH_R(" i ".75))" )
        check("same(of_angles[" scene "_ANGLE_" a[i] "], \"" a[i] "\")")
        check("same(in_angles[" scene "_ANGLE_" a[i] "], \"rad\")")
        check_real("RATE", a[i], "'", i ".375", "rad/s")
        reals++
    }
    for (i = 1; i <= given; i++) {
        check("state.input[" scene "_INPUT_" u[i] "] == WH_R(" i ".25)")
        check("same(of_inputs[" scene "_INPUT_" u[i] "], \"" u[i] "\")")
        check("same(in_inputs[" scene "_INPUT_" u[i] "], \"N\")")
    }
    for (i = 1; i <= shown; i++) {
        check("output[" scene "_OUTPUT_" o[i] "] == WH_R(1.5) + WH_R(" i ".0)")
        check("same(of_outputs[" scene "_OUTPUT_" o[i] "], \"" o[i] "\")")
        check("same(in_outputs[" scene "_OUTPUT_" o[i] "], \"m\")")
    }
    check(scene "_REALS == " reals " && " scene "_ANGLES == " turns " && " scene "_INPUTS == " given)
    check(scene "_OUTPUTS == " shown + (conserved ? 2 : 0))
    print "scene " scene " \"" text() "\" {" (third ? "" : " use m" number ";") " start " substr(starts, 3) \
        (conserved ? "; conserve " x[lengths] : "") "; step 1 [ms]; until 1 [s] }" >file
    print scene
}
