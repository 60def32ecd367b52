#!/bin/sh
# page.sh FIGURE.fig...: print docs/figures.md, the page with every figure of the dissertation.
set -eu
cat <<'END'
# Figures

The dissertation's simulated figures, drawn anew from Whirl's runs, to be scrolled through beside
it, and the two that its rig measured, from what the rig's firmware heard of its bench in the loop
([pil.md](pil.md)): the same quantities on the axes, units labelled, captions our own. What follows
from them is in [findings.md](findings.md), the mechanisms are in [models.md](models.md).

`make figures` draws each as SVG and PNG in `build/figures/`; `make figures-docs` also copies the SVGs
and this page, which is made from the descriptions `mk/figures/*.fig`, into `docs/`. The drawings hold
no date and no machine's name: drawn twice, they are the same files. The commands below print the
numbers behind each figure.

Not here: figures 1 to 10, 12 to 16, 18, 21 to 23, 25, 27 to 31, 35, 41 to 43, 47 to 49 and 56 are
drawings and photographs. What figure 25's carriage does on its rail, as the firmware measures it,
is in [rig.md](rig.md#on-a-carriage).
END
for fig in "$@"; do
    name=$(basename "$fig" .fig)
    printf '\n## Figure %s: %s\n\n' "${name#fig}" "$(sed -n 's/^title //p' "$fig")"
    printf '![figure %s](figures/%s.svg)\n\n' "${name#fig}" "$name"
    sed -n 's/^caption //p' "$fig"
    printf '\n```sh\n'
    sed -n -e 's/^run [a-z0-9]* \(.*\)/build\/whirl run \1 --csv -/p' \
        -e 's/^sweep [a-z0-9]* \(.*\)/build\/whirl sweep \1/p' \
        -e 's/^table [a-z0-9]* \([a-z]*\.sh\)\(.*\)/sh mk\/figures\/\1 build\/whirl\2/p' "$fig"
    printf '```\n'
done
