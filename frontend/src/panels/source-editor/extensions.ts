import { closeBrackets, closeBracketsKeymap, completionKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { bracketMatching, foldGutter, foldKeymap, indentOnInput, indentUnit } from "@codemirror/language";
import { lintGutter, lintKeymap } from "@codemirror/lint";
import { highlightSelectionMatches, search, searchKeymap } from "@codemirror/search";
import { EditorState, type Extension } from "@codemirror/state";
import { drawSelection, EditorView, highlightActiveLine, highlightSpecialChars, keymap, lineNumbers, tooltips } from "@codemirror/view";
import { strings } from "../../strings";
import { shortenPath } from "../place";
import { detectIndentation, syntaxOf } from "./languages";
import { markedLines } from "./marks";
import { phrases } from "./phrases";
import { pageTheme } from "./theme";

/** Returns the extensions of an editor that need no language server. */
export function createBaseExtensions(path: string, text: string, isReadOnly: boolean): Extension {
  const texts = strings.sourceEditor;
  const label = texts.text(shortenPath(path, 2));
  return [
    lineNumbers(),
    foldGutter(),
    lintGutter(),
    highlightSpecialChars(),
    history(),
    drawSelection(),
    indentOnInput(),
    bracketMatching(),
    closeBrackets(),
    highlightActiveLine(),
    highlightSelectionMatches(),
    search({ top: true }),
    keymap.of([
      ...closeBracketsKeymap,
      ...defaultKeymap,
      ...searchKeymap,
      ...historyKeymap,
      ...foldKeymap,
      ...completionKeymap,
      ...lintKeymap,
      indentWithTab,
    ]),
    indentUnit.of(detectIndentation(text)),
    EditorState.phrases.of(phrases),
    EditorState.readOnly.of(isReadOnly),
    EditorView.contentAttributes.of({ "aria-label": label, "aria-description": texts.keys, tabindex: "0" }),
    tooltips({ parent: document.body }), // the dock clips what extends beyond a panel
    markedLines,
    pageTheme,
    syntaxOf(path),
  ];
}
