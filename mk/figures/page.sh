#!/bin/sh
# page.sh FIGURE.fig...: print docs/figures.md, the page with every figure of the dissertation.
set -eu
cat <<'END'
# Figures

Whirl draws the dissertation's simulated figures, and two measured figures from the rig's firmware
in the loop ([pil.md](pil.md)). [findings.md](findings.md) has the conclusions,
[models.md](models.md) the mechanisms. The command below each figure prints its numbers. The
dissertation's other figures are drawings and photographs.

`make figures` draws them in `build/figures/`. `make figures-docs` renews this page and its pictures.
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
