# SPDX-License-Identifier: BSD-3-Clause
"""What aquafarm_plan and aquafarm_report share."""
