#!/bin/sh
# help.sh: `make help-all` lists every public target and all targets that the docs name; `make` alone lists at most 30.
# Files and suites that the docs name exist.
. "$(dirname "$0")/../checks.sh"

MAKEFLAGS= make help-all >"$scratch/help" 2>"$scratch/err" &&
    sed -n 's/^  make \([a-zA-Z0-9-]*\) .*/\1/p' "$scratch/help" | sort -u >"$scratch/listed"
verdict $? "make help-all prints a list"
MAKEFLAGS= make >"$scratch/help" 2>"$scratch/err" &&
    sed -n 's/^  make \([a-zA-Z0-9-]*\) .*/\1/p' "$scratch/help" | sort >"$scratch/first" &&
    comm -23 "$scratch/first" "$scratch/listed" >"$scratch/err" && [ ! -s "$scratch/err" ] &&
    [ "$(wc -l <"$scratch/first")" -le 30 ] && [ "$(wc -l <"$scratch/first")" -ge 20 ]
verdict $? "make alone lists at most 30 of them"

# Targets that only other targets call: second halves (-now), and parts.
parts='FORCE|objects|test-objects|board-objects|asan-run|image-rules|board-images|board-tests|run-suites|test-programs|fuzz-programs'
parts="$parts|price-measure-board|price-measure-host|price-ready-board|price-ready-host|price-count-run-board|board-own-objects|emulate-command|short-images|print-hashes|print-short-hashes|print-matrix-hashes|print-settings|settings-written|settings-programs|settings-images|hard-images|print-hard-hashes|tidy-board|docs-programs|flashed-rules|flashed-tests|firstlight-record|.*-now|gate-.*|hash-.*|host-.*|suites-.*"
MAKEFLAGS= make -pnq FORCE 2>/dev/null | sed -n 's/^\.PHONY: *//p' | tr ' ' '\n' | grep . | sort -u >"$scratch/known"
[ "$(wc -l <"$scratch/known")" -ge 40 ] && grep -vxE "$parts" "$scratch/known" | comm -23 - "$scratch/listed" >"$scratch/err" &&
    [ ! -s "$scratch/err" ]
verdict $? "every target that make knows is listed"
grep -v NAME "$scratch/listed" | comm -23 - "$scratch/known" >"$scratch/err" && [ ! -s "$scratch/err" ]
verdict $? "every target that is listed is known"

cat README.md CONTRIBUTING.md docs/*.md docs/dev/*.md Makefile mk/*.mk tests/*.sh tests/*/*.sh mk/*/*.sh core/*.h core/*/*.h boards/*/*.[ch] |
    grep -oE '(`|^    |^)make [a-z][a-z0-9-]*($|[ `])' | sed 's/.*make //; s/[ `]$//' | sort -u >"$scratch/told"
sed 's/^gate-.*/gate-NAME/' "$scratch/told" | sort -u | comm -23 - "$scratch/listed" >"$scratch/err" && [ ! -s "$scratch/err" ] &&
    [ "$(wc -l <"$scratch/told")" -ge 15 ]
verdict $? "every target that the docs tell of is listed"
# files and suites that the docs name exist
for page in README.md CONTRIBUTING.md docs/*.md docs/dev/*.md; do
    grep -oE '`(sh )?(core|host|hal|boards|mk|tests|docs)/[A-Za-z0-9_./*-]+' "$page" | sed 's/^`\(sh \)\{0,1\}//' | grep -v NAME |
        sort -u | while read -r path; do
        ls -d $path >/dev/null 2>&1 || echo "$page: $path"
    done
    grep -ohE 'build/tests/(host|core_float|core_double) [a-z0-9_ ]+' "$page" | sed 's|build/tests/||; s/_float\|_double//' |
        while read -r kind suites; do
            for suite in $suites; do
                grep -qE "^(void suite_|SUITE\(|TEST\()${suite#suite_}[(,)]" tests/"$kind"/test_*.c || echo "$page: $kind $suite"
            done
        done
done >"$scratch/err"
[ ! -s "$scratch/err" ]
verdict $? "every file and suite that the docs name is there"
for digits in 'm32: ## a target with digits' 'a-2b: x ## one more'; do
    printf '##@ Some\n%s\n' "$digits" >"$scratch/one.mk"
    awk -f mk/help.awk "$scratch/one.mk" | grep -q "make ${digits%%:*} .*${digits##*## }"
    verdict $? "$digits"
done
exit $failed
