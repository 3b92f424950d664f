"""The language server: the protocol of editors around the room `language`; needs the extra ``lsp``."""
