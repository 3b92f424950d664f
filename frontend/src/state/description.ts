import type { Connection } from "../connection/connection";
import type { DescriptionChanged, InertiaFinding, InertiaFindings } from "../protocol";
import { Signal } from "../signal";
import { DescriptionModel } from "./description-model";

/** The links and joints that an edit on disk changed. */
export interface EditedElements {
  readonly display: string;
  readonly links: readonly string[];
  readonly joints: readonly string[];
}

/**
 * The descriptions of the robots. The server only announces changes; descriptions are requested while a view holds
 * them, and texts when they are read.
 */
export class DescriptionState {
  /** The description of a display has arrived. */
  readonly arrived = new Signal<DescriptionModel>();
  /** The findings about the masses of a display's robot have arrived. */
  readonly findingsArrived = new Signal<string>();
  /** An edit changed links or joints. */
  readonly edited = new Signal<EditedElements>();
  /** A text has arrived. */
  readonly textArrived = new Signal();
  /** The user asked for a place, such as that of a diagnostic or link; `name` is the file's name for users. */
  readonly placeRequested = new Signal<{ file: string; line: number; display?: string; name?: string }>();
  /** Texts that were read may have changed. */
  readonly textsOutdated = new Signal();
  private readonly revisions = new Map<string, number>();
  private readonly models = new Map<string, DescriptionModel>();
  private readonly findings = new Map<string, InertiaFindings>();
  /** The texts that have arrived; undefined while a request is pending, null if the file does not exist. */
  private readonly texts = new Map<string, string | null | undefined>();
  private modelHolderCount = 0;
  private findingHolderCount = 0;

  constructor(private readonly connection: Connection) {
    connection.on("hello", () => this.revisions.clear());
    connection.on("tree", ({ displays }) => {
      const displayIds = new Set(displays.map((display) => display.id));
      for (const entries of [this.revisions, this.models, this.findings]) {
        for (const display of entries.keys()) if (!displayIds.has(display)) entries.delete(display);
      }
    });
    connection.on("description_changed", (message) => this.onDescriptionChanged(message));
    connection.on("description", (message) => {
      const model = new DescriptionModel(message);
      this.models.set(message.display, model);
      this.arrived.emit(model);
    });
    connection.on("inertia_findings", (message) => {
      this.findings.set(message.display, message);
      this.findingsArrived.emit(message.display);
    });
    connection.on("description_text", ({ display, file, text }) => {
      this.texts.set(createTextKey(display, file), text);
      this.textArrived.emit();
    });
    // While a description has an error, its texts are those with the error; otherwise those of the robot shown.
    connection.on("diagnostics", () => this.forgetTexts());
  }

  /** Keeps the descriptions of all displays up to date until the returned function is called. */
  hold(): () => void {
    this.modelHolderCount += 1;
    if (this.modelHolderCount === 1) {
      for (const [display, revision] of this.revisions) {
        if (this.models.get(display)?.description.revision !== revision) this.request("request_description", display);
      }
    }
    return runOnce(() => (this.modelHolderCount -= 1));
  }

  /** Keeps the findings about masses up to date until the returned function is called. */
  holdFindings(): () => void {
    this.findingHolderCount += 1;
    if (this.findingHolderCount === 1) {
      for (const [display, revision] of this.revisions) {
        if (this.findings.get(display)?.revision !== revision) this.request("request_inertia", display);
      }
    }
    return runOnce(() => (this.findingHolderCount -= 1));
  }

  /** Returns the description of a display, if it has arrived; it may be slightly out of date. */
  modelOf(display: string): DescriptionModel | undefined {
    return this.models.get(display);
  }

  findingsOf(display: string): readonly InertiaFinding[] {
    return this.findings.get(display)?.findings ?? [];
  }

  /** Returns a text if it has arrived, otherwise requests it; null if it does not exist. */
  textOf(display: string, file: string): string | null | undefined {
    const key = createTextKey(display, file);
    if (!this.texts.has(key)) {
      this.texts.set(key, undefined);
      this.connection.send({ type: "request_description_text", display, file });
    }
    return this.texts.get(key);
  }

  private onDescriptionChanged({ display, revision, links, joints }: DescriptionChanged): void {
    const isNew = this.revisions.get(display) !== revision;
    this.revisions.set(display, revision);
    if (isNew) {
      this.forgetTexts();
      if (this.modelHolderCount > 0) this.request("request_description", display);
      if (this.findingHolderCount > 0) this.request("request_inertia", display);
    }
    if (links.length + joints.length > 0) this.edited.emit({ display, links, joints });
  }

  private request(type: "request_description" | "request_inertia", display: string): void {
    this.connection.send({ type, display });
  }

  private forgetTexts(): void {
    this.texts.clear();
    this.textsOutdated.emit();
  }
}

function createTextKey(display: string, file: string): string {
  return `${display} ${file}`;
}

function runOnce(action: () => void): () => void {
  let hasRun = false;
  return () => {
    if (!hasRun) action();
    hasRun = true;
  };
}
