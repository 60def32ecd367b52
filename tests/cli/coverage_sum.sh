#!/bin/sh
# coverage_sum.sh: the counts of `make coverage` (mk/coverage/coverage.awk) on lines as gcov writes them. A header's line
# counts once, whichever object ran it. Branches of a line count by the objects that have most of them. Other folders do not
# count.
. "$(dirname "$0")/../checks.sh"

# Two objects: each ran line 3 one way. In a third, one of the two conditions is constant, and all remaining branches were
# taken. Line 4 ran in one object, line 5 in none; line 9 is in another folder.
cat >"$scratch/text" <<'END'
        -:    0:Source:core/a.h
        -:    1:/* a comment */
        4:    3:    if (a && b) {
branch  0 taken 4 (fallthrough)
branch  1 taken 0
branch  2 taken 0 (fallthrough)
branch  3 taken 4
call    4 returned 4
    #####:    4:        x();
    #####:    5:        y();
branch  0 never executed
branch  1 never executed (fallthrough)
        -:    0:Source:tests/b.c
    #####:    9:        z();
        -:    0:Source:core/a.h
       2*:    3:    if (a && b) {
branch  0 taken 1 (fallthrough)
branch  1 taken 1
branch  2 taken 0 (fallthrough)
branch  3 taken 1
        1:    4:        x();
    #####:    5:        y();
branch  0 never executed
branch  1 never executed (fallthrough)
        -:    0:Source:core/a.h
        7:    3:    if (a && b) {
branch  0 taken 3 (fallthrough)
branch  1 taken 4
        -:    0:Source:./core/c.c
        1:    8:    return;
END

sum() { # sum LINES_LEAST BRANCHES_LEAST
    awk -v only='^core/' -v missed="$scratch/missed" -v lines_least="$1" -v branches_least="$2" \
        -f mk/coverage/coverage.awk "$scratch/text" >"$scratch/said"
}

sum 75 50
cp "$scratch/said" "$scratch/err"
verdict $? "as many as asked for are enough"
grep -q '^core/a.h  *2 of  *3  66.67 %  *3 of  *6  50.00 %$' "$scratch/said"
verdict $? "lines and branches of a header, once each"
grep -q '^core/c.c  *1 of  *1 100.00 %  *0 of  *0 100.00 %$' "$scratch/said"
verdict $? "a file without branches"
grep -q '^all  *3 of  *4  75.00 %  *3 of  *6  50.00 %$' "$scratch/said"
verdict $? "their sum, without other folders"
printf '%s\n' 'core/a.h:3: branch 3 of 4:    if (a && b) {' 'core/a.h:5: line:        y();' |
    cmp -s - "$scratch/missed"
verdict $? "what is missed: the branch of a line that ran, and the line that did not"
! sum 75.01 50
verdict $? "fewer lines than asked for fail"
! sum 75 50.01
verdict $? "fewer branches than asked for fail"
: >"$scratch/text"
! sum 0 0
verdict $? "nothing at all fails"
exit "$failed"
