"""The second door of training: body models from a user's own registered meshes (OWN_BODIES.md)."""
