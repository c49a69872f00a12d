"""Expression: a clip and an Effort come in, the clip as that Effort plays it goes out."""
