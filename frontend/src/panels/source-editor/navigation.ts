import type { LSPClient } from "@codemirror/lsp-client";
import type { ChangeSet } from "@codemirror/state";
import { EditorView } from "@codemirror/view";
import { strings } from "../../strings";
import { shortPath } from "../place";
import type { Documents } from "./documents";
import type { ListedFile, ListedPlace, PlaceList } from "./place-list";
import { pathOf, placeOf, positionIn, type ServerRange } from "./server-places";
import type { SourceDocument } from "./source-document";
import { messageOf } from "./workspace-edit";

/** A place in a file, as in the protocol of language servers. */
export interface ServerLocation {
  readonly uri: string;
  readonly range: ServerRange;
}

/** A place in a document, which moves with the text. */
interface Bookmark {
  readonly document: SourceDocument;
  position: number;
}

const MAX_BACK = 100;
const CONTEXT = 80;

/** Definitions, references, and the way back to the places before. */
export class Navigation {
  private readonly back: Bookmark[] = [];
  private readonly forward: Bookmark[] = [];
  private listed: Bookmark[] = [];
  private isReturning = false;

  /** @param tell - called with messages for the user. */
  constructor(
    private readonly client: LSPClient,
    private readonly documents: Documents,
    private readonly list: PlaceList,
    private readonly tell: (message: string) => void,
  ) {}

  /** Goes to the definition of the name at a position; lists the definitions if there are several. */
  goToDefinition(view: EditorView, position = view.state.selection.main.head): boolean {
    const texts = strings.sourceEditor;
    void this.ask(view, "textDocument/definition", position, {}).then(async (found) => {
      const [first, ...others] = found;
      if (!first) this.tell(texts.noDefinition);
      else if (others.length === 0) await this.open(first);
      else await this.show(texts.definitions(found.length), found);
    }).catch((error: unknown) => this.tell(messageOf(error)));
    return true;
  }

  /** Lists the uses of the name at the cursor, its definition included. */
  listReferences(view: EditorView): boolean {
    const texts = strings.sourceEditor;
    const { head } = view.state.selection.main;
    void this.ask(view, "textDocument/references", head, { context: { includeDeclaration: true } }).then(async (found) => {
      if (found.length === 0) this.tell(texts.noReferences);
      else await this.show(texts.references(found.length), found);
    }).catch((error: unknown) => this.tell(messageOf(error)));
    return true;
  }

  /** Opens a place of a file, and puts the cursor there. */
  async open({ uri, range }: ServerLocation): Promise<void> {
    const path = pathOf(uri);
    const document = path === null ? null : await this.documents.load(path);
    if (document) await this.go(document, positionIn(document.state.doc, range.start));
  }

  /** Remembers the place of the cursor, to which `goBack` returns. */
  leave(): void {
    const here = this.here();
    const last = this.back.at(-1);
    if (!here || this.isReturning || (last?.document === here.document && last.position === here.position)) return;
    this.back.push(here);
    this.forward.length = 0;
    if (this.back.length > MAX_BACK) this.back.shift();
  }

  goBack(): boolean {
    return this.goTo(this.back, this.forward);
  }

  goForward(): boolean {
    return this.goTo(this.forward, this.back);
  }

  /** Moves the remembered places with the text of a document. */
  record(document: SourceDocument, changes: ChangeSet): void {
    for (const bookmark of [...this.back, ...this.forward, ...this.listed]) {
      if (bookmark.document === document) bookmark.position = changes.mapPos(bookmark.position);
    }
  }

  private async go(document: SourceDocument, position: number): Promise<void> {
    this.leave();
    if (!(await this.documents.show(document.path))) return;
    const { view } = this.documents;
    const anchor = Math.min(position, view.state.doc.length);
    view.dispatch({ selection: { anchor }, effects: EditorView.scrollIntoView(anchor, { y: "center" }), userEvent: "select.definition" });
    view.focus();
  }

  private goTo(from: Bookmark[], to: Bookmark[]): boolean {
    const here = this.here();
    const target = from.pop();
    if (!target) return true;
    if (here) to.push(here);
    this.isReturning = true;
    void this.go(target.document, target.position).finally(() => (this.isReturning = false));
    return true;
  }

  private here(): Bookmark | null {
    const { shown, view } = this.documents;
    return shown && { document: shown, position: view.state.selection.main.head };
  }

  private async ask(view: EditorView, method: string, position: number, more: object): Promise<ServerLocation[]> {
    const { shown } = this.documents;
    if (!shown) return [];
    this.client.sync();
    const asked = { textDocument: { uri: shown.uri }, position: placeOf(view.state.doc, position), ...more };
    const found = await this.client.request<object, ServerLocation | ServerLocation[] | null>(method, asked);
    return found === null ? [] : [found].flat();
  }

  private async show(heading: string, locations: readonly ServerLocation[]): Promise<void> {
    const files = new Map<string, ServerLocation[]>();
    for (const location of locations) files.set(location.uri, [...(files.get(location.uri) ?? []), location]);
    this.listed = [];
    const listed: ListedFile[] = [];
    for (const [uri, own] of files) {
      const path = pathOf(uri);
      const document = path === null ? null : await this.documents.load(path);
      if (document) listed.push({ name: shortPath(document.path), path: document.path, places: own.map(({ range }) => this.listedPlace(document, range)) });
    }
    this.list.show(heading, listed);
  }

  private listedPlace(document: SourceDocument, range: ServerRange): ListedPlace {
    const { doc } = document.state;
    const bookmark = { document, position: positionIn(doc, range.start) };
    this.listed.push(bookmark);
    return { ...excerpt(document, range), open: () => void this.go(document, bookmark.position) };
  }
}

/** Returns the line of a range, in three parts. */
export function excerpt({ state: { doc } }: SourceDocument, range: ServerRange): Omit<ListedPlace, "open"> {
  const [from, to] = [positionIn(doc, range.start), positionIn(doc, range.end)];
  const line = doc.lineAt(from);
  const end = Math.min(to, line.to);
  return {
    line: line.number,
    before: doc.sliceString(Math.max(line.from, from - CONTEXT), from).trimStart(),
    name: doc.sliceString(from, end),
    after: doc.sliceString(end, Math.min(line.to, end + CONTEXT)),
  };
}
