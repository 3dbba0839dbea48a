#!/bin/sh
# test_inflate_checks.sh - a vector of the conformance suite detects the absence of each check of
# the program that annex L prints, or GAPS.md says why none can
# (conformance/tests/inflate_checks.py). Prints lines as a cmocka program does; run by `make test`
# from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
. tests/support/speak.sh
need inflate_checks python3
PYTHONDONTWRITEBYTECODE=1 python3 conformance/tests/inflate_checks.py
