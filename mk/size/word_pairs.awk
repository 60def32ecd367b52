# word_pairs.awk: core/word_pairs.h for what stands in WH_WORDS(): of files behind the preprocessor, with WH_WORDS_PACKED=1.
#
# Byte pair encoding (Gage, 1994): the most frequent pair becomes a byte of its own, again and again. A pair is no deeper than
# DEEP others, which bounds the memory of who unpacks it.

BEGIN {
    DEEP = 8
    for (i = 32; i < 127; i++) { number_of[sprintf("%c", i)] = i }
    for (i = 0; i < 128; i++) { deep[i] = 0 }
}

# Texts, numbers one behind the other, 0 behind each.
{
    while (match($0, /WH_PACK_THESE_WORDS *\("[^"]*"\)/)) {
        words = substr($0, RSTART, RLENGTH)
        $0 = substr($0, RSTART + RLENGTH)
        gsub(/^[^"]*"|"\)$/, "", words)
        for (i = 1; i <= length(words); i++) { all[count++] = number_of[substr(words, i, 1)] }
        all[count++] = 0
    }
}

function most_frequent(    i, key, most) {
    for (key in seen) { delete seen[key] }
    for (i = 0; i + 1 < count; i++) {
        if (all[i] == 0 || all[i + 1] == 0 || deep[all[i]] >= DEEP || deep[all[i + 1]] >= DEEP) { continue }
        seen[all[i] * 256 + all[i + 1]]++
        if (all[i] == all[i + 1] && all[i + 1] == all[i + 2]) { i++ } # of three equal ones two are a pair
    }
    most = 2 # less is not worth it
    best = -1
    for (key in seen) {
        if (seen[key] > most || (seen[key] == most && best >= 0 && key + 0 < best)) { most = seen[key]; best = key + 0 }
    }
    return best
}

function replace(left, right, by,    i, kept) {
    kept = 0
    for (i = 0; i < count; i++) {
        if (all[i] == left && i + 1 < count && all[i + 1] == right) {
            all[kept++] = by
            i++
        } else {
            all[kept++] = all[i]
        }
    }
    count = kept
}

END {
    before = count
    for (made = 128; made < 256; made++) {
        pair = most_frequent()
        if (pair < 0) { break }
        left = int(pair / 256)
        right = pair % 256
        shown[made] = text(left) text(right)
        deep[made] = 1 + (deep[left] > deep[right] ? deep[left] : deep[right])
        rows = rows sprintf(" \\\n    X(%d, %d, %d) /* \"%s\" */", made, left, right, shown[made])
        replace(left, right, made)
    }
    print "/* word_pairs.h: the pairs that core/packed_words.h is about, made by `make word-pairs` of the words as they were then:"
    printf " * %d bytes, packed %d. Other words are packed as well, if less.\n *\n", before, count
    print " * X(number, left, right): what the byte `number` stands for; either may be a pair above it. */"
    print "#ifndef WH_WORD_PAIRS_H"
    print "#define WH_WORD_PAIRS_H"
    print ""
    print "enum { WH_WORD_PAIRS_DEEP = " DEEP " }; /* pairs within pairs, at most */"
    print ""
    print "#define WH_WORD_PAIR_ROWS(X)" rows
    print ""
    print "#endif"
}

function text(number) { return number < 128 ? sprintf("%c", number) : shown[number] }
