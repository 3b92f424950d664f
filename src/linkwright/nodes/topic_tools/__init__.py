"""The programs of topic_tools: they forward messages of any type between topics."""
