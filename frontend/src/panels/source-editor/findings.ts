import { setDiagnostics, type Diagnostic } from "@codemirror/lint";
import type { EditorState, TransactionSpec } from "@codemirror/state";
import type { EditorView } from "@codemirror/view";
import { strings } from "../../strings";
import type { ServerFinding } from "./documents";
import { offsetOf } from "./server-places";

const SEVERITIES = ["error", "error", "warning", "info", "hint"] as const;

/** Opens the menu of the fixes of a finding. */
export type FixFinding = (view: EditorView, range: { from: number; to: number }) => void;

/**
 * Returns the transaction that shows findings in a text.
 *
 * @param openFixes - opens the fixes of a finding; null in a text that cannot be edited.
 */
export function showFindings(state: EditorState, findings: readonly ServerFinding[], openFixes: FixFinding | null): TransactionSpec {
  const actions = openFixes === null ? [] : [{ name: strings.sourceEditor.fix, apply: (view: EditorView, from: number, to: number) => openFixes(view, { from, to }) }];
  return setDiagnostics(state, findings.map((finding) => ({ ...toDiagnostic(state, finding), actions })));
}

function toDiagnostic({ doc }: EditorState, { range, severity = 1, code, message }: ServerFinding): Diagnostic {
  const [from, to] = [offsetOf(doc, range.start), offsetOf(doc, range.end)];
  return {
    from,
    to: Math.max(from, to),
    severity: SEVERITIES[severity] ?? "info",
    ...(code === undefined ? {} : { source: String(code) }),
    message,
  };
}
