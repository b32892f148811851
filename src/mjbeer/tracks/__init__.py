"""Tracks of filmed cans, and the fit that finds from a track what was in the can.

- `track`: a track, and how it is read from a table.
- `board`: places on a board, from points of its picture and from marks on it.
- `unknowns`: the values that a fit looks for, and the variables of the solver.
- `track_model`: the track that a scene would give without noise.
- `first_guess`: the values from which the search begins.
- `least_squares`: the search, and the errors of the values that it finds.
- `doubts`: reasons to doubt a fit.
- `result`: the result, in words and pictures.
- `fit`: all of this in one call.
"""
