# SPDX-License-Identifier: BSD-3-Clause
"""The verbs of ./aquafarm. The script itself installs and builds; `workspace` calls it for that."""
