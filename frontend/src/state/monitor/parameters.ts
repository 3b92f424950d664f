import type { Connection } from "../../connection/connection";
import type { NodeParameters, ParameterDump, ParameterKind, ParameterResult } from "../../protocol";
import { Signal } from "../../signal";

/** The nodes with parameters, and the parameters of the chosen node. */
export class ParametersState {
  readonly nodesChanged = new Signal();
  readonly changed = new Signal();
  readonly resultArrived = new Signal<ParameterResult>();
  readonly dumpArrived = new Signal<ParameterDump>();
  nodes: readonly string[] = [];
  node: string | null = null;
  /** The parameters of the chosen node; null until the node has answered. */
  parameters: NodeParameters | null = null;
  private isWatching = false;

  constructor(private readonly connection: Connection) {
    connection.on("hello", () => {
      if (this.isWatching) this.sendWatch();
    });
    connection.on("parameter_nodes", ({ nodes }) => {
      this.nodes = nodes;
      this.nodesChanged.emit();
    });
    connection.on("node_parameters", (parameters) => {
      if (parameters.node !== this.node) return;
      this.parameters = parameters;
      this.changed.emit();
    });
    connection.on("parameter_result", (result) => {
      if (result.node === this.node) this.resultArrived.emit(result);
    });
    connection.on("parameter_dump", (dump) => this.dumpArrived.emit(dump));
  }

  watch(isWatched: boolean): void {
    if (isWatched === this.isWatching) return;
    this.isWatching = isWatched;
    this.sendWatch();
  }

  chooseNode(node: string | null): void {
    this.node = node;
    this.parameters = null;
    this.changed.emit();
    this.sendWatch();
  }

  set(name: string, kind: ParameterKind, values: string[]): void {
    if (this.node !== null) this.connection.send({ type: "set_parameter", node: this.node, name, kind, values });
  }

  dump(): void {
    if (this.node !== null) this.connection.send({ type: "dump_parameters", node: this.node });
  }

  private sendWatch(): void {
    const node = this.isWatching ? this.node : null;
    this.connection.send({ type: "watch_parameters", wants_list: this.isWatching, node });
  }
}
