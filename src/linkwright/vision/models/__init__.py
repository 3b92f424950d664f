"""Networks that come with Linkwright, each with its card."""
