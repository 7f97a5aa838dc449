"""A benchmark of renderers that others submit to: python -m mote.benchmark run, score, verify, references, scenes.

A suite (benchmark/suite.json) names scenes, sizes, budgets, seeds and two references each. A submission is a folder of
pictures at equal times with a manifest, submission.json. docs/measurements/benchmark.md has the rules.
"""
