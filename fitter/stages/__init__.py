"""Steps that a fit of a new picture and the refit of a fitted one have in common."""
