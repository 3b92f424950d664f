"""Export of robots as one HTML page that needs no server, or as glTF."""
