import type { LSPClient } from "@codemirror/lsp-client";
import type { ChangeSet } from "@codemirror/state";
import { EditorView } from "@codemirror/view";
import { strings } from "../../strings";
import { shortenPath } from "../place";
import type { Documents } from "./documents";
import type { ListedFile, ListedPlace, PlaceList } from "./place-list";
import { pathOf, serverPositionOf, offsetOf, type ServerRange } from "./server-places";
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

const MAX_HISTORY = 100;
const CONTEXT_LENGTH = 80;

/** Definitions, references, and the way back to the places before. */
export class Navigation {
  private readonly history: Bookmark[] = [];
  private readonly forward: Bookmark[] = [];
  private listedPlaces: Bookmark[] = [];
  private isReturning = false;

  /** @param showMessage - called with messages for the user. */
  constructor(
    private readonly client: LSPClient,
    private readonly documents: Documents,
    private readonly list: PlaceList,
    private readonly showMessage: (message: string) => void,
  ) {}

  /** Goes to the definition of the name at a position; lists the definitions if there are several. */
  goToDefinition(view: EditorView, position = view.state.selection.main.head): boolean {
    const texts = strings.sourceEditor;
    void this.requestLocations(view, "textDocument/definition", position, {}).then(async (locations) => {
      const [firstLocation, ...otherLocations] = locations;
      if (!firstLocation) this.showMessage(texts.noDefinition);
      else if (otherLocations.length === 0) await this.open(firstLocation);
      else await this.showList(texts.definitions(locations.length), locations);
    }).catch((error: unknown) => this.showMessage(messageOf(error)));
    return true;
  }

  /** Lists the uses of the name at the cursor, its definition included. */
  listReferences(view: EditorView): boolean {
    const texts = strings.sourceEditor;
    const { head } = view.state.selection.main;
    void this.requestLocations(view, "textDocument/references", head, { context: { includeDeclaration: true } }).then(async (locations) => {
      if (locations.length === 0) this.showMessage(texts.noReferences);
      else await this.showList(texts.references(locations.length), locations);
    }).catch((error: unknown) => this.showMessage(messageOf(error)));
    return true;
  }

  /** Opens a place of a file, and puts the cursor there. */
  async open({ uri, range }: ServerLocation): Promise<void> {
    const path = pathOf(uri);
    const document = path === null ? null : await this.documents.load(path);
    if (document) await this.jumpTo(document, offsetOf(document.state.doc, range.start));
  }

  /** Stores the place of the cursor, to which `goBack` returns. */
  recordPosition(): void {
    const bookmark = this.createBookmark();
    const lastBookmark = this.history.at(-1);
    if (!bookmark || this.isReturning || (lastBookmark?.document === bookmark.document && lastBookmark.position === bookmark.position)) return;
    this.history.push(bookmark);
    this.forward.length = 0;
    if (this.history.length > MAX_HISTORY) this.history.shift();
  }

  goBack(): boolean {
    return this.goTo(this.history, this.forward);
  }

  goForward(): boolean {
    return this.goTo(this.forward, this.history);
  }

  /** Moves the stored places with the text of a document. */
  record(document: SourceDocument, changes: ChangeSet): void {
    for (const bookmark of [...this.history, ...this.forward, ...this.listedPlaces]) {
      if (bookmark.document === document) bookmark.position = changes.mapPos(bookmark.position);
    }
  }

  private async jumpTo(document: SourceDocument, position: number): Promise<void> {
    this.recordPosition();
    if (!(await this.documents.show(document.path))) return;
    const { view } = this.documents;
    const anchor = Math.min(position, view.state.doc.length);
    view.dispatch({ selection: { anchor }, effects: EditorView.scrollIntoView(anchor, { y: "center" }), userEvent: "select.definition" });
    view.focus();
  }

  private goTo(source: Bookmark[], destination: Bookmark[]): boolean {
    const bookmark = this.createBookmark();
    const target = source.pop();
    if (!target) return true;
    if (bookmark) destination.push(bookmark);
    this.isReturning = true;
    void this.jumpTo(target.document, target.position).finally(() => (this.isReturning = false));
    return true;
  }

  private createBookmark(): Bookmark | null {
    const { shownDocument, view } = this.documents;
    return shownDocument && { document: shownDocument, position: view.state.selection.main.head };
  }

  private async requestLocations(view: EditorView, method: string, position: number, parameters: object): Promise<ServerLocation[]> {
    const { shownDocument } = this.documents;
    if (!shownDocument) return [];
    this.client.sync();
    const request = { textDocument: { uri: shownDocument.uri }, position: serverPositionOf(view.state.doc, position), ...parameters };
    const locations = await this.client.request<object, ServerLocation | ServerLocation[] | null>(method, request);
    return locations === null ? [] : [locations].flat();
  }

  private async showList(heading: string, locations: readonly ServerLocation[]): Promise<void> {
    const files = new Map<string, ServerLocation[]>();
    for (const location of locations) files.set(location.uri, [...(files.get(location.uri) ?? []), location]);
    this.listedPlaces = [];
    const listedFiles: ListedFile[] = [];
    for (const [uri, ranges] of files) {
      const path = pathOf(uri);
      const document = path === null ? null : await this.documents.load(path);
      if (document) listedFiles.push({ name: shortenPath(document.path), path: document.path, places: ranges.map(({ range }) => this.createPlace(document, range)) });
    }
    this.list.show(heading, listedFiles);
  }

  private createPlace(document: SourceDocument, range: ServerRange): ListedPlace {
    const { doc } = document.state;
    const bookmark = { document, position: offsetOf(doc, range.start) };
    this.listedPlaces.push(bookmark);
    return { ...createExcerpt(document, range), open: () => void this.jumpTo(document, bookmark.position) };
  }
}

/** Returns the line of a range, in three parts. */
export function createExcerpt({ state: { doc } }: SourceDocument, range: ServerRange): Omit<ListedPlace, "open"> {
  const [from, to] = [offsetOf(doc, range.start), offsetOf(doc, range.end)];
  const line = doc.lineAt(from);
  const end = Math.min(to, line.to);
  return {
    line: line.number,
    textBefore: doc.sliceString(Math.max(line.from, from - CONTEXT_LENGTH), from).trimStart(),
    name: doc.sliceString(from, end),
    textAfter: doc.sliceString(end, Math.min(line.to, end + CONTEXT_LENGTH)),
  };
}
