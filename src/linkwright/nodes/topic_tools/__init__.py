"""The programs of topic_tools, which forward messages of any type between topics."""
