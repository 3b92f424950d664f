"""Compare other kinds of files: worlds, parameters, maps, interfaces, manifests and meshes."""
