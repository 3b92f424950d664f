import type { Connection } from "../../connection/connection";
import type { TopicMessage, TopicRow, TopicTraffic } from "../../protocol";
import { Signal } from "../../signal";

/** The topics, and details of those that a view watches. */
export class TopicsState {
  readonly listChanged = new Signal();
  readonly figuresChanged = new Signal();
  readonly messageArrived = new Signal<TopicMessage>();
  topics: readonly TopicRow[] = [];
  /** Whether the topics have arrived since the page connected. */
  known = false;
  readonly traffic = new Map<string, TopicTraffic>();
  readonly messages = new Map<string, TopicMessage>();
  private readonly readers = new Set<object>();
  private measured: readonly string[] = [];
  private opened: readonly string[] = [];

  constructor(private readonly connection: Connection) {
    connection.on("hello", () => {
      this.known = false;
      if (this.readers.size > 0 || this.measured.length > 0) this.sendWatch();
    });
    connection.on("topic_list", ({ topics }) => {
      this.topics = topics;
      this.known = true;
      this.listChanged.emit();
    });
    connection.on("topic_figures", ({ traffic }) => {
      for (const each of traffic) this.traffic.set(each.topic, each);
      this.figuresChanged.emit();
    });
    connection.on("topic_message", (message) => {
      if (!this.opened.includes(message.topic)) return;
      this.messages.set(message.topic, message);
      this.messageArrived.emit(message);
    });
  }

  /** Starts or stops keeping the list of topics up to date for a reader. */
  watchList(reader: object, wanted: boolean): void {
    const before = this.readers.size;
    if (wanted) this.readers.add(reader);
    else this.readers.delete(reader);
    if (before === 0 || this.readers.size === 0) this.sendWatch();
  }

  /** Sets the topics to measure, and those whose last message is requested. */
  watch(measured: Iterable<string>, opened: Iterable<string>): void {
    this.measured = [...measured];
    this.opened = [...opened];
    const watched = new Set([...this.measured, ...this.opened]);
    for (const topic of this.traffic.keys()) if (!watched.has(topic)) this.traffic.delete(topic);
    for (const topic of this.messages.keys()) if (!this.opened.includes(topic)) this.messages.delete(topic);
    this.sendWatch();
    this.figuresChanged.emit();
  }

  private sendWatch(): void {
    const { measured, opened } = this;
    this.connection.send({ type: "watch_topics", listed: this.readers.size > 0, measured: [...measured], opened: [...opened] });
  }
}
