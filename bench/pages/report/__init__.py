"""bench/report.md and bench/report-tables.md: what the method shows.
SPDX-License-Identifier: BSD-2-Clause"""
