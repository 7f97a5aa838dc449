"""Claims of a figure script, each printed with its measured value.

A claim that does not hold as the paper states it stays in the list, word for word, with `differs` set to the reason,
and is printed as one that does not hold. The script fails when a claim without a reason does not hold, and just as much
when one that is said to differ holds after all.
"""


class Claims:
    checked = []  # of this run: claim, measured, 'holds' or 'does not hold'

    def __init__(self):
        self._wrong = 0
        self._differing = 0
        self._count = 0

    def check(self, claim, measured, holds, differs=None):
        self._count += 1
        self._wrong += bool(holds) == (differs is not None)
        self._differing += not holds
        self.checked.append([claim, measured, "holds" if holds else "does not hold"])
        print(f"{'holds         ' if holds else 'DOES NOT HOLD '} {claim}: {measured}")
        if differs:
            print(f"                {'said to differ, but holds' if holds else 'why: ' + differs}")

    def exit_code(self):
        print(f"{self._count} claims, {self._differing} do not hold as stated, {self._wrong} not as documented here")
        return 1 if self._wrong else 0
