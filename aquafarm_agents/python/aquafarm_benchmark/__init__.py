# SPDX-License-Identifier: BSD-3-Clause
"""The evaluation protocol of §4.2: trains, evaluates, compares and draws.

protocol  the learners, the length of their trainings, and the paper's results
runs      the trainings, in parallel, each resumable
cluster   the Dask workers that execute them: of this machine, a scheduler or Slurm
worker    the part of a run that executes on a worker
measures  convergence, stability, EA, interquartile means and intervals
results   the table and the result files of a benchmark
figures   Figs. 12 to 14 and the learning curves; route_figure: Fig. 11
"""
