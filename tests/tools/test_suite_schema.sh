#!/bin/sh
# test_suite_schema.sh - manifest, descriptors, answers and reports of the conformance suite conform
# to conformance/schema (conformance/tests/schemas.py). Prints lines as a cmocka program does; run
# by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
. tests/support/speak.sh
need suite_schema python3 ted4conf ted4dec
PYTHONDONTWRITEBYTECODE=1 python3 conformance/tests/schemas.py
