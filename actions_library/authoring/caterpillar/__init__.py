"""A caterpillar, 1.1 m long: skeleton, body, clips and actions, made by code alone."""
