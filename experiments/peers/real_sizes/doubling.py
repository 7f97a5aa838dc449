"""How many passes the next picture has: the same rule for every program, each in its own Python."""


def next_passes(runs, budget):
    """None where the pictures so far (each with `passes` and `wall_s`) leave no time for it within `budget` seconds.

    Passes double; but after the first picture, which has one, as many as take a thirty-second of the budget. There
    are two pictures at least: what is systematic needs them. A budget that is a list says the passes of each picture.
    """
    if isinstance(budget, list):
        return budget[len(runs)] if len(runs) < len(budget) else None
    if not runs:
        return 1
    n, seconds = runs[-1]["passes"], max(runs[-1]["wall_s"], 1e-3)
    more = 2 * n
    while len(runs) == 1 and 2 * more * seconds / n <= budget / 16:
        more *= 2
    spent = sum(run["wall_s"] for run in runs)
    if spent + more * seconds / n <= budget:
        return more
    return n if len(runs) == 1 else None
