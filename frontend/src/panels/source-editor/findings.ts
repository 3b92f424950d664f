import { setDiagnostics, type Diagnostic } from "@codemirror/lint";
import type { EditorState, TransactionSpec } from "@codemirror/state";
import type { ServerFinding } from "./language-service";
import { positionIn } from "./server-places";

const SEVERITIES = ["error", "error", "warning", "info", "hint"] as const;

/** Returns the transaction that shows findings in a text. */
export function showFindings(state: EditorState, findings: readonly ServerFinding[]): TransactionSpec {
  return setDiagnostics(state, findings.map((finding) => diagnosticOf(state, finding)));
}

function diagnosticOf({ doc }: EditorState, { range, severity = 1, code, message }: ServerFinding): Diagnostic {
  const [from, to] = [positionIn(doc, range.start), positionIn(doc, range.end)];
  return {
    from,
    to: Math.max(from, to),
    severity: SEVERITIES[severity] ?? "info",
    ...(code === undefined ? {} : { source: String(code) }),
    message,
  };
}
