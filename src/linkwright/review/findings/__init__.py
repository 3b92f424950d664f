"""Compare the findings of `linkwright check` in both versions."""
