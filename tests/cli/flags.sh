#!/bin/sh
# flags.sh: a few of the flag matrix's sets; `make flags` takes them all.
exec sh "$(dirname "$0")/../flags.sh" fast
