"""Files of maps: a YAML file and a picture."""
