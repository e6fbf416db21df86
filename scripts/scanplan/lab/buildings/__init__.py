"""Buildings to simulate surveys in: drawings, meshes and models, and the ways through them."""
