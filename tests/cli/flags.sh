#!/bin/sh
# flags.sh: a few of the flag matrix's sets, in float; with WHIRL_FULL in double; `make flags` takes all.
exec sh "$(dirname "$0")/../flags.sh" fast
