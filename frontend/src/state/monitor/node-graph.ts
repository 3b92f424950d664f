import type { Connection } from "../../connection/connection";
import type { NodeGraph } from "../../protocol";
import { Signal } from "../../signal";

/** The nodes and topics of the graph, up to date while a view shows them. */
export class NodeGraphState {
  readonly changed = new Signal();
  graph: NodeGraph = { type: "node_graph", nodes: [], topics: [] };
  private isWatched = false;

  constructor(private readonly connection: Connection) {
    connection.on("hello", () => {
      if (this.isWatched) this.sendWatch();
    });
    connection.on("node_graph", (graph) => {
      this.graph = graph;
      this.changed.emit();
    });
  }

  watch(isWatched: boolean): void {
    if (isWatched === this.isWatched) return;
    this.isWatched = isWatched;
    this.sendWatch();
  }

  private sendWatch(): void {
    this.connection.send({ type: "watch_node_graph", watched: this.isWatched });
  }
}
