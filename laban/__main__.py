"""``python -m laban``: the tables of features and qualities, as the docs show them."""

from laban.features import feature_table
from laban.qualities import quality_table

if __name__ == "__main__":
    print(feature_table())
    print(quality_table(), end="")
