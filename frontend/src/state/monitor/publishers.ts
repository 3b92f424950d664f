import type { Connection } from "../../connection/connection";
import type { PagePublisher, PublisherState } from "../../protocol";
import { Signal } from "../../signal";
import type { TextStorage } from "../../storage";

const STORAGE_KEY = "linkwright.publishers.1";
const DEFAULT_RATE_HZ = 1;

/** The publishers of the page. The browser keeps them, but they publish only after the user has turned them on. */
export class PublishersState {
  /** Publishers were added or removed, or a template has arrived. */
  readonly listChanged = new Signal();
  readonly statesChanged = new Signal();
  readonly typesArrived = new Signal();
  publishers: PagePublisher[];
  types: readonly string[] = [];
  readonly states = new Map<number, PublisherState>();
  private isOpen = false;
  private nextId = 1;

  constructor(
    private readonly connection: Connection,
    private readonly storage: TextStorage,
  ) {
    this.publishers = parsePublishers(storage.getItem(STORAGE_KEY)).map((publisher) => ({ ...publisher, id: this.nextId++, is_on: false }));
    connection.on("hello", () => {
      if (!this.isOpen) return;
      this.connection.send({ type: "request_types" });
      this.send();
    });
    connection.on("message_types", ({ types }) => {
      this.types = types;
      this.typesArrived.emit();
    });
    connection.on("message_template", ({ kind, text }) => {
      for (const publisher of this.publishers) if (publisher.kind === kind && publisher.text === "") publisher.text = text;
      this.listChanged.emit();
      this.send();
    });
    connection.on("publisher_states", ({ states }) => {
      for (const state of states) this.states.set(state.id, state);
      this.statesChanged.emit();
    });
  }

  /** Requests the types when the panel opens; publishers continue while it is hidden. */
  open(): void {
    if (this.isOpen) return;
    this.isOpen = true;
    this.connection.send({ type: "request_types" });
    this.send();
  }

  add(topic: string, kind: string): void {
    this.publishers.push({ id: this.nextId++, topic, kind, rate: DEFAULT_RATE_HZ, text: "", is_on: false });
    this.connection.send({ type: "request_template", name: kind });
    this.listChanged.emit();
  }

  remove(id: number): void {
    this.publishers = this.publishers.filter((publisher) => publisher.id !== id);
    this.states.delete(id);
    this.listChanged.emit();
    this.send();
  }

  change(id: number, changes: Partial<PagePublisher>): void {
    this.publishers = this.publishers.map((publisher) => (publisher.id === id ? { ...publisher, ...changes } : publisher));
    this.send();
  }

  publishOnce(id: number): void {
    this.connection.send({ type: "publish_once", id });
  }

  private send(): void {
    this.storage.setItem(STORAGE_KEY, JSON.stringify(this.publishers));
    this.connection.send({ type: "set_publishers", publishers: this.publishers });
  }
}

function parsePublishers(text: string | null): PagePublisher[] {
  try {
    const publishers: unknown = JSON.parse(text ?? "[]");
    return Array.isArray(publishers) ? (publishers as PagePublisher[]).filter(isPublisher) : [];
  } catch {
    return [];
  }
}

function isPublisher({ topic, kind, rate, text }: PagePublisher): boolean {
  return typeof topic === "string" && typeof kind === "string" && typeof text === "string" && Number.isFinite(rate);
}
