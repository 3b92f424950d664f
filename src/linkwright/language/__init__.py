"""What an editor asks about the files of robot packages, without a protocol: findings, symbols, completions."""
