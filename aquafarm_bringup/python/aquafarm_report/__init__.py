# SPDX-License-Identifier: BSD-3-Clause
"""A run or a benchmark as one self-contained HTML file, readable on a phone."""
