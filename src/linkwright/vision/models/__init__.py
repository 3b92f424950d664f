"""Networks that come with Linkwright, with their cards."""
