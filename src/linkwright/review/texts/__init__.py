"""Write changes as short texts: merge equal ones, shorten long ones, and hide secrets."""
