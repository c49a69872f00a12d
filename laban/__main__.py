"""``python -m laban``: the table of features, as the docs show it."""

from laban.features import feature_table

if __name__ == "__main__":
    print(feature_table(), end="")
