# SPDX-License-Identifier: BSD-3-Clause
"""The evaluation protocol of the paper (§4.2): trains, evaluates, compares and draws.

cli           the program aquafarm_benchmark
protocol      the learners, the length of their trainings, and the paper's results
runs          executes trainings and evaluations in parallel; they can be resumed
cluster       the Dask workers that execute them: on this machine, of a scheduler, or of Slurm
worker        the part of a run that executes on a worker
measures      convergence, stability, EA, interquartile means and intervals
losses        money losses of evaluated episodes
human         episodes that people played, as a row of the benchmark
results       the tables and result files of a benchmark
output        writes the tables and draws the figures of a complete benchmark
figures       Figs. 12a, 12b, 13 and 14 of the paper
error_figure  Fig. 12c of the paper
evaluation_figure  the returns of evaluations
loss_figures  charts of money losses
style         headlines, names of lines and colours of the figures
headlines     the headlines of figures
route_figure  Fig. 11 of the paper: a policy's choices and its route
unfinished_figure  the routes of failed episodes, grouped by cause
sweep, many   the programs aquafarm_sweep and aquafarm_many
"""
