# front.awk: marks the front: the rows whose error no row with the same or a lower price beats. Its input are rows of
# priced.awk, with counted rows in place of the predicted ones, sorted by scene, board, rising price and error:
#
#   sort ROWS | awk -F, -v counted=BOARDS -f front.awk
#
# On the boards in `counted`, whose fronts count.sh has counted, only counted rows are marked.

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
