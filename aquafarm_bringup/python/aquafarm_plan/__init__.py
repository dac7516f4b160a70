# SPDX-License-Identifier: BSD-3-Clause
"""Makes the page and the GeoJSON of a rescue plan from its plan file. The program aquafarm_plan of
the package aquafarm_agents writes this file."""
