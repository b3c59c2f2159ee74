# `make batch` runs this with the program built: a result for each line of the list, with -j2 two at a time.
# Lines are known by their numbers, so that no name of a case or constant has to pass through make or a shell.

list := geo/batch.txt
lines := $(shell scripts/batch.py lines $(list))

.PHONY: all $(lines)
all: $(lines)
	@:

# What has not changed is for coralpipe to find out: it compares contents, also of files that make does not know.
$(lines):
	@scripts/batch.py run $(list) $@
