#!/bin/sh
# flags.sh: some sets of the flag matrix, in float; with WHIRL_FULL in double. `make flags` takes all.
exec sh "$(dirname "$0")/../flags.sh" fast
