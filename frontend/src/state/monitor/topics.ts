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
  isKnown = false;
  readonly traffic = new Map<string, TopicTraffic>();
  readonly messages = new Map<string, TopicMessage>();
  private readonly readers = new Set<object>();
  private measuredTopics: readonly string[] = [];
  private openTopics: readonly string[] = [];

  constructor(private readonly connection: Connection) {
    connection.on("hello", () => {
      this.isKnown = false;
      if (this.readers.size > 0 || this.measuredTopics.length > 0) this.sendWatch();
    });
    connection.on("topic_list", ({ topics }) => {
      this.topics = topics;
      this.isKnown = true;
      this.listChanged.emit();
    });
    connection.on("topic_figures", ({ traffic }) => {
      for (const topicTraffic of traffic) this.traffic.set(topicTraffic.topic, topicTraffic);
      this.figuresChanged.emit();
    });
    connection.on("topic_message", (message) => {
      if (!this.openTopics.includes(message.topic)) return;
      this.messages.set(message.topic, message);
      this.messageArrived.emit(message);
    });
  }

  /** Starts or stops keeping the list of topics up to date for a reader. */
  watchList(reader: object, isWanted: boolean): void {
    const previousCount = this.readers.size;
    if (isWanted) this.readers.add(reader);
    else this.readers.delete(reader);
    if (previousCount === 0 || this.readers.size === 0) this.sendWatch();
  }

  /** Sets the topics to measure, and those whose last message is requested. */
  watch(measuredTopics: Iterable<string>, openTopics: Iterable<string>): void {
    this.measuredTopics = [...measuredTopics];
    this.openTopics = [...openTopics];
    const watched = new Set([...this.measuredTopics, ...this.openTopics]);
    for (const topic of this.traffic.keys()) if (!watched.has(topic)) this.traffic.delete(topic);
    for (const topic of this.messages.keys()) if (!this.openTopics.includes(topic)) this.messages.delete(topic);
    this.sendWatch();
    this.figuresChanged.emit();
  }

  private sendWatch(): void {
    const { measuredTopics, openTopics } = this;
    this.connection.send({ type: "watch_topics", wants_list: this.readers.size > 0, measured_topics: [...measuredTopics], opened_topics: [...openTopics] });
  }
}
