"""The language server, which offers the functions of `language` to editors.

It needs the extra ``lsp``.
"""
