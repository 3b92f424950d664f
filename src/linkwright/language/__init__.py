"""The answers to questions of editors about files of robot packages, without a protocol."""
