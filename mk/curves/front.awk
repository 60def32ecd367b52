# front.awk: marks the front: what nothing beats that is as cheap. Rows of priced.awk, by scene, board, rising price and
# error, with the counted ones in place of theirs:
#
#   sort ROWS | awk -F, -v counted=BOARDS -f front.awk
#
# On the boards of `counted`, whose fronts count.sh has counted, only rows that were counted themselves are marked.

{
    if ($1 != scene || $2 != board) {
        scene = $1
        board = $2
        best = ""
        only_counted = index(" " counted " ", " " board " ") > 0
    }
    on = (best == "" || $3 + 0 < best) && (!only_counted || $12 == "counted")
    if (on) { best = $3 + 0 }
    print $0, on
}
