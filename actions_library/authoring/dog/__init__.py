"""A dog, 0.55 m at the shoulder: skeleton, body, clips and actions, made by code alone."""
