"""Editor features for the files of robot packages, independent of any protocol."""
