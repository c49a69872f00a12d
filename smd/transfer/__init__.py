"""Transfer: a Score and its recording come in, the moves of each performer go out."""
