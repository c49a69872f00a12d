"""Acting: moves or poses come in, actors on the ground and a Performance go out."""
