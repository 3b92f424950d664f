import type { LSPClient } from "@codemirror/lsp-client";
import type { EditorView } from "@codemirror/view";
import { strings } from "../../strings";
import { openMenuAt, type MenuEntry } from "../../widgets/menu";
import type { Documents, ServerFinding } from "./documents";
import { colorPickerAt } from "./meanings";
import { serverPositionOf } from "./server-places";
import { applyWorkspaceEdit, messageOf, type WorkspaceEdit } from "./workspace-edit";

/** A fix or refactoring, as in the protocol of language servers. */
interface CodeAction {
  readonly title: string;
  readonly kind?: string;
  readonly isPreferred?: boolean;
  readonly edit?: WorkspaceEdit | null;
}

const ACTION_KINDS = ["quickfix", "source.fixAll", "refactor.extract", "refactor.inline", "refactor.rewrite"];

/** The client's capabilities for code actions, for the server. */
export const ACTION_CAPABILITIES = {
  textDocument: {
    codeAction: {
      codeActionLiteralSupport: { codeActionKind: { valueSet: ACTION_KINDS } },
      isPreferredSupport: true,
      dataSupport: true,
      resolveSupport: { properties: ["edit"] },
    },
  },
  workspace: { workspaceEdit: { documentChanges: true, resourceOperations: ["create"] } },
};

/** The menu of fixes and refactorings at a place of the text. */
export class CodeActions {
  /**
   * @param client - the connection to the language server.
   * @param findingsOf - returns the findings of a file by its URI.
   * @param showMessage - called with messages for the user.
   */
  constructor(
    private readonly client: LSPClient,
    private readonly documents: Documents,
    private readonly findingsOf: (uri: string) => readonly ServerFinding[],
    private readonly showMessage: (message: string) => void,
  ) {}

  /** Opens the menu for the selection, or for another range. */
  open(view: EditorView, range: { from: number; to: number } = view.state.selection.main): boolean {
    void this.showMenu(view, range).catch((error: unknown) => this.showMessage(messageOf(error)));
    return true;
  }

  private async showMenu(view: EditorView, { from, to }: { from: number; to: number }): Promise<void> {
    const { shownDocument } = this.documents;
    if (!shownDocument || shownDocument.readOnlyReason !== "") return;
    this.client.sync();
    const { doc } = view.state;
    const range = { start: serverPositionOf(doc, from), end: serverPositionOf(doc, to) };
    const [firstLine, lastLine] = [range.start.line, range.end.line];
    const diagnostics = this.findingsOf(shownDocument.uri).filter((finding) => finding.range.start.line <= lastLine && finding.range.end.line >= firstLine);
    const request = { textDocument: { uri: shownDocument.uri }, range, context: { diagnostics } };
    const actions = (await this.client.request<object, CodeAction[] | null>("textDocument/codeAction", request)) ?? [];
    if (shownDocument !== this.documents.shownDocument) return;
    const chooseColor = colorPickerAt(view, from);
    if (actions.length === 0 && chooseColor === null) {
      this.showMessage(strings.sourceEditor.noActions);
      return;
    }
    const anchor = view.coordsAtPos(Math.min(from, view.state.doc.length)) ?? view.dom.getBoundingClientRect();
    openMenuAt(anchor.left, anchor.bottom + 2, view.contentDOM, [
      ...(chooseColor === null ? [] : [{ label: strings.sourceEditor.chooseColor, run: chooseColor }]),
      ...this.createEntries(actions),
    ]);
  }

  private createEntries(actions: readonly CodeAction[]): MenuEntry[] {
    const sortedActions = [...actions].sort((a, b) => rankOf(a) - rankOf(b));
    return sortedActions.map((action, index) => {
      const previous = sortedActions[index - 1];
      return {
        label: action.title,
        hint: action.title,
        hasLineAbove: previous !== undefined && groupOf(previous) !== groupOf(action),
        run: () => void this.run(action).then(this.showMessage, (error: unknown) => this.showMessage(messageOf(error))),
      };
    });
  }

  private async run(action: CodeAction): Promise<string> {
    const { edit } = action.edit ? action : await this.client.request<CodeAction, CodeAction>("codeAction/resolve", action);
    const changedDocuments = edit ? await applyWorkspaceEdit(this.client, edit, this.documents, "action") : [];
    const [document] = changedDocuments;
    // The result may be in another file, such as the xacro that a URDF is converted to.
    if (document && changedDocuments.length === 1 && document !== this.documents.shownDocument) await this.documents.show(document.path);
    return strings.sourceEditor.acted(action.title, changedDocuments.length);
  }
}

function groupOf({ kind = "" }: CodeAction): number {
  return ACTION_KINDS.findIndex((knownKind) => kind === knownKind || kind.startsWith(`${knownKind}.`)) < 2 ? 0 : 1;
}

function rankOf(action: CodeAction): number {
  const kind = action.kind ?? "";
  return groupOf(action) * 4 + (kind === "source.fixAll" ? 2 : 0) + (action.isPreferred === true ? 0 : 1);
}
