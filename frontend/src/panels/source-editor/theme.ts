import { HighlightStyle, syntaxHighlighting } from "@codemirror/language";
import type { Extension } from "@codemirror/state";
import { EditorView } from "@codemirror/view";
import { tags } from "@lezer/highlight";

/** The page's colors; they are variables, so that the editor follows the theme by itself. */
const colors = EditorView.theme({
  // Not `&` alone: the box of the tooltips, which is in the page's body, has the class of the theme, too.
  "&.cm-editor": { height: "100%", background: "var(--bg-field)", color: "var(--text)", fontSize: "12px" },
  "&.cm-focused": { outline: "none" },
  ".cm-scroller": { fontFamily: "var(--mono)", lineHeight: "18px" },
  ".cm-content": { caretColor: "var(--text)" },
  ".cm-cursor, .cm-dropCursor": { borderLeftColor: "var(--text)" },
  ".cm-gutters": { background: "var(--bg-field)", color: "var(--text-faint)", borderRight: "1px solid var(--line)" },
  ".cm-activeLine, .cm-activeLineGutter": { background: "color-mix(in srgb, var(--text) 5%, transparent)" },
  ".cm-line.cm-focus-line": { background: "var(--accent-wash)", boxShadow: "inset 2px 0 0 var(--accent)" },
  ".cm-line.cm-problem-line": { boxShadow: "inset 2px 0 0 var(--error)" },
  "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground": {
    background: "var(--selection)",
  },
  ".cm-selectionMatch": { background: "var(--accent-wash)" },
  ".cm-matchingBracket, &.cm-focused .cm-matchingBracket": { background: "none", outline: "1px solid var(--edge)" },
  ".cm-nonmatchingBracket, &.cm-focused .cm-nonmatchingBracket": { background: "none", color: "var(--error)" },
  ".cm-searchMatch": { background: "color-mix(in srgb, var(--warn) 30%, transparent)" },
  ".cm-searchMatch.cm-searchMatch-selected": { background: "color-mix(in srgb, var(--warn) 55%, transparent)" },
  ".cm-foldPlaceholder": { background: "var(--bg-raised)", border: "1px solid var(--line)", color: "var(--text-soft)" },
  ".cm-panels": { background: "var(--bg-bar)", color: "var(--text)", font: "12px var(--font)" },
  ".cm-panels.cm-panels-top": { borderBottom: "1px solid var(--line)" },
  ".cm-panels.cm-panels-bottom": { borderTop: "1px solid var(--line)" },
  ".cm-textfield": { background: "var(--bg-field)", border: "1px solid var(--edge)", color: "var(--text)", borderRadius: "3px" },
  ".cm-button": { background: "var(--bg-raised)", border: "1px solid var(--line-strong)", color: "var(--text)", borderRadius: "3px" },
  ".cm-panel button[name=close], .cm-dialog-close": { color: "var(--text-soft)" },
  ".cm-tooltip": {
    background: "var(--bg-panel)",
    border: "1px solid var(--line-strong)",
    borderRadius: "var(--radius)",
    boxShadow: "var(--shadow-soft)",
    color: "var(--text)",
    maxWidth: "min(560px, 90vw)",
  },
  ".cm-tooltip.cm-tooltip-autocomplete > ul": { fontFamily: "var(--mono)", maxHeight: "15em" },
  ".cm-tooltip.cm-tooltip-autocomplete > ul > li[aria-selected]": { background: "var(--accent-deep)", color: "var(--text-on-accent)" },
  ".cm-tooltip-autocomplete > ul > li[aria-selected] .cm-completionDetail": { color: "var(--text-on-accent)" },
  ".cm-tooltip.cm-completionInfo": { whiteSpace: "normal" },
  ".cm-completionDetail": { color: "var(--text-soft)", fontStyle: "normal" },
  ".cm-completionMatchedText": { textDecoration: "none", fontWeight: "600" },
  ".cm-lintRange": { backgroundImage: "none !important", textDecoration: "underline wavy 1px", textUnderlineOffset: "3px" },
  ".cm-lintRange-active": { backgroundColor: "var(--accent-wash)" },
  ".cm-lintRange-error": { textDecorationColor: "var(--error)" },
  ".cm-lintRange-warning": { textDecorationColor: "var(--warn)" },
  ".cm-lintRange-info, .cm-lintRange-hint": { textDecorationColor: "var(--accent)" },
  ".cm-diagnostic": { whiteSpace: "pre-wrap", padding: "4px 8px" },
  ".cm-diagnostic-error": { borderLeft: "4px solid var(--error)" },
  ".cm-diagnostic-warning": { borderLeft: "4px solid var(--warn)" },
  ".cm-diagnostic-info, .cm-diagnostic-hint": { borderLeft: "4px solid var(--accent)" },
  ".cm-inlay-hint": {
    background: "var(--bg-raised)",
    borderRadius: "3px",
    color: "var(--text-soft)",
    fontSize: "11px",
    margin: "0 3px",
    padding: "0 3px",
  },
  ".cm-color": { cursor: "pointer", marginRight: "3px" },
  ".cm-color > i": { border: "1px solid var(--edge)", borderRadius: "2px", display: "inline-block", height: "10px", verticalAlign: "-1px", width: "10px" },
  ".cm-token-macro, .cm-token-function": { color: "var(--accent)" },
  ".cm-token-parameter, .cm-token-variable, .cm-token-enumMember, .cm-token-number": { color: "var(--xml-expression)" },
  ".cm-token-parameter": { fontStyle: "italic" },
  ".cm-token-operator, .cm-token-keyword": { color: "var(--xml-tag)" },
  ".cm-token-interface": { color: "var(--joint)" },
  ".cm-token-class": { color: "var(--accent)" },
  ".cm-token-definition": { fontWeight: "600" },
  ".cm-diagnosticAction": {
    background: "var(--bg-raised)",
    border: "1px solid var(--line-strong)",
    borderRadius: "3px",
    color: "var(--text)",
    padding: "1px 6px",
  },
  // An option of a list contains no buttons; Enter goes to the finding, whose fixes Ctrl+. shows.
  ".cm-panel-lint .cm-diagnosticAction": { display: "none" },
  ".cm-panel.cm-panel-lint ul [aria-selected], .cm-panel.cm-panel-lint ul:focus [aria-selected]": {
    background: "var(--accent-wash)",
    color: "var(--text)",
  },
  ".cm-panel.cm-panel-lint": { font: "12px var(--font)" },
  ".cm-panel-lint .cm-diagnostic": { overflowWrap: "anywhere", paddingRight: "24px" },
});

const syntax = HighlightStyle.define([
  { tag: [tags.tagName, tags.keyword, tags.definitionKeyword, tags.controlKeyword, tags.moduleKeyword, tags.angleBracket], color: "var(--xml-tag)" },
  { tag: [tags.attributeName, tags.propertyName, tags.definition(tags.propertyName)], color: "var(--xml-attribute)" },
  { tag: [tags.attributeValue, tags.string], color: "var(--xml-value)" },
  { tag: [tags.number, tags.bool, tags.null, tags.atom], color: "var(--xml-expression)" },
  { tag: [tags.function(tags.variableName), tags.className, tags.definition(tags.variableName)], color: "var(--accent)" },
  { tag: [tags.comment, tags.processingInstruction, tags.documentMeta, tags.meta], color: "var(--text-faint)", fontStyle: "italic" },
  { tag: tags.invalid, color: "var(--error)" },
]);

export const pageTheme: Extension = [colors, syntaxHighlighting(syntax)];
