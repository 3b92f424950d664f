import type { Connection } from "../../connection/connection";
import type { UnsavedTextEdited, UnsavedTextShown } from "../../protocol";
import { isWithinMessageSize } from "./message-size";
import type { SourceDocument } from "./source-document";

/** A text is sent this time after its last change, ms. */
const SEND_DELAY_MS = 300;

/** The documents of the editor, for the scene. */
interface LiveDocuments {
  readonly open: readonly SourceDocument[];
  /** Whether a file belongs to a description that the page shows. */
  isShownInScene(path: string): boolean;
  /** Applies an edit that was made in the scene. */
  applyEdit(edit: UnsavedTextEdited): void;
}

/** Shows the unsaved texts in the scene, soon after they were typed. */
export class LiveTexts {
  private timer: ReturnType<typeof setTimeout> | undefined;
  private lastRequestNumber = 0;
  /** The newest request about each file whose unsaved text the server has, or has not yet removed. */
  private readonly newestRequests = new Map<string, { readonly number: number; readonly isRemoval: boolean }>();
  private readonly outcomes = new Map<string, UnsavedTextShown["outcome"]>();

  /** @param onOutcome - called when the server has shown a text, or could not. */
  constructor(
    private readonly connection: Connection,
    private readonly documents: LiveDocuments,
    private readonly onOutcome: () => void,
  ) {
    connection.on("unsaved_text_shown", (message) => this.onShown(message));
    connection.on("unsaved_text_edited", (message) => documents.applyEdit(message));
  }

  /** Whether the scene shows unsaved texts, or the robot from before their errors; null if there are none. */
  get outcome(): "shown" | "errors" | null {
    const outcomes = [...this.outcomes.values()];
    return (["errors", "shown"] as const).find((outcome) => outcomes.includes(outcome)) ?? null;
  }

  /** Sends the texts that have changed, after a pause. */
  scheduleSending(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.send(), SEND_DELAY_MS);
  }

  /** Sends all unsaved texts to a server that has none of them, because it was restarted. */
  resendAll(): void {
    this.newestRequests.clear();
    this.outcomes.clear();
    for (const document of this.documents.open) document.describedText = null;
    this.send();
  }

  private send(): void {
    for (const document of this.documents.open) {
      const { path } = document;
      const hasServerText = this.newestRequests.get(path)?.isRemoval === false;
      if (document.isUnsaved && this.documents.isShownInScene(path)) {
        if (document.newestSent?.changes.empty === true) continue;
        const text = document.state.doc.toString();
        if (!isWithinMessageSize(text)) continue;
        this.lastRequestNumber += 1;
        document.recordSent(this.lastRequestNumber);
        this.request(path, text);
      } else if (hasServerText && !document.isUnsaved) {
        this.lastRequestNumber += 1;
        document.recordSent(this.lastRequestNumber);
        this.request(path, null);
      }
    }
  }

  private request(path: string, text: string | null): void {
    this.newestRequests.set(path, { number: this.lastRequestNumber, isRemoval: text === null });
    this.connection.send({ type: "show_unsaved_text", number: this.lastRequestNumber, path, text });
  }

  private onShown({ number, path, outcome }: UnsavedTextShown): void {
    const document = this.documents.open.find((candidate) => candidate.path === path);
    if (!document) return;
    document.recordShown(number, outcome === "shown");
    const newestRequest = this.newestRequests.get(path);
    if (newestRequest?.number !== number) return;
    if (newestRequest.isRemoval) {
      this.outcomes.delete(path);
      this.newestRequests.delete(path);
      document.describedText = null;
    } else this.outcomes.set(path, outcome);
    this.onOutcome();
  }
}
