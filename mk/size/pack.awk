# pack.awk core/word_pairs.h FILE: FILE, which is behind the preprocessor, with what stands in WH_WORDS() packed (core/packed_words.h).

BEGIN { for (i = 32; i < 127; i++) { number_of[sprintf("%c", i)] = i } }

NR == FNR {
    if (match($0, /X\([0-9]+, [0-9]+, [0-9]+\)/)) {
        split(substr($0, RSTART + 2, RLENGTH - 3), row, ", ")
        made[pairs] = row[1]
        left[pairs] = row[2]
        right[pairs++] = row[3]
    }
    next
}

# As in a literal of C.
function packed(words,    i, p, n, kept, out) {
    n = length(words)
    for (i = 1; i <= n; i++) { all[i] = number_of[substr(words, i, 1)] }
    for (p = 0; p < pairs; p++) {
        kept = 0
        for (i = 1; i <= n; i++) {
            if (i < n && all[i] == left[p] && all[i + 1] == right[p]) {
                all[++kept] = made[p]
                i++
            } else {
                all[++kept] = all[i]
            }
        }
        n = kept
    }
    for (i = 1; i <= n; i++) { out = out (all[i] < 128 ? sprintf("%c", all[i]) : sprintf("\\%03o", all[i])) }
    return "\"" out "\""
}

{
    while (match($0, /WH_PACK_THESE_WORDS *\("[^"\\]*"\)/)) {
        words = substr($0, RSTART, RLENGTH)
        before = substr($0, 1, RSTART - 1)
        behind = substr($0, RSTART + RLENGTH)
        gsub(/^[^"]*"|"\)$/, "", words)
        $0 = before packed(words) behind
    }
    if (/WH_PACK_THESE_WORDS/) {
        print FILENAME ": WH_WORDS() holds one literal without a backslash, on its line" >"/dev/stderr"
        failed = 1
    }
    print
}

END { exit failed || pairs == 0 }
