"""A moon with a face and no limbs: skeleton, face, shapes, clips and actions, by code alone."""
