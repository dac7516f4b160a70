# SPDX-License-Identifier: BSD-3-Clause
"""The verbs of ./aquafarm. The module `workspace` calls the script to install and build."""
