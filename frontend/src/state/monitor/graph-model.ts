import type { GraphTopic, NodeGraph } from "../../protocol";

export type GraphMode = "nodes" | "active" | "all";

export interface GraphOptions {
  /** Show nodes only, topics that connect nodes, or all topics. */
  mode: GraphMode;
  /** Whether to show topics that every node has. */
  debug: boolean;
  tf: boolean;
  /** Whether the nodes of a namespace are one vertex, unless its group is open. */
  grouped: boolean;
  openGroups: ReadonlySet<string>;
}

export interface GraphVertex {
  id: string;
  kind: "node" | "topic" | "action" | "group";
  label: string;
  /** The number of nodes in a group. */
  count: number;
}

interface GraphEdge {
  from: string;
  to: string;
  /** The topics of the edge, if topics are not vertices. */
  topics: string[];
}

export interface DrawnGraph {
  vertices: GraphVertex[];
  edges: GraphEdge[];
}

const DEBUG_TOPICS = new Set(["/rosout", "/parameter_events", "/statistics", "/diagnostics_agg"]);
const DEBUG_NODES = /(^|\/)_?(ros2cli|rqt_gui)[^/]*$/;
const TF_TOPICS = new Set(["/tf", "/tf_static"]);
const ACTION = "/_action/";

/** Returns the vertices and edges to draw for a graph. */
export function drawnGraph(graph: NodeGraph, options: GraphOptions): DrawnGraph {
  const vertices = new Map<string, GraphVertex>();
  const nodes = graph.nodes.filter((name) => options.debug || !DEBUG_NODES.test(name));
  const owners = new Map(nodes.map((name) => [name, ownerOf(name, options)]));
  for (const owner of owners.values()) {
    const known = vertices.get(owner.id);
    if (known) known.count++;
    else vertices.set(owner.id, { ...owner });
  }
  const edges = new Map<string, GraphEdge>();
  const connect = (from: string, to: string, topics: string[]): void => {
    const key = `${from}\n${to}`;
    const known = edges.get(key);
    if (!known) edges.set(key, { from, to, topics });
    else known.topics = [...new Set([...known.topics, ...topics])];
  };
  const endsOf = (names: readonly string[]): string[] => [
    ...new Set(names.map((name) => owners.get(name)?.id).filter((id) => id !== undefined)),
  ];
  for (const topic of topicsOf(graph, options)) {
    const [publishers, subscribers] = [endsOf(topic.publishers), endsOf(topic.subscribers)];
    if (options.mode !== "all" && (publishers.length === 0 || subscribers.length === 0)) continue;
    const [first, ...others] = new Set([...publishers, ...subscribers]);
    // Topics within a closed group are not shown.
    if (others.length === 0 && vertices.get(first ?? "")?.kind === "group") continue;
    if (options.mode === "nodes") {
      for (const [from, to] of pairsOf(publishers, subscribers)) connect(from, to, [topic.name]);
      continue;
    }
    const id = `topic:${topic.name}`;
    vertices.set(id, { id, kind: topic.action ? "action" : "topic", label: topic.name, count: 0 });
    for (const from of publishers) connect(from, id, []);
    for (const to of subscribers) connect(id, to, []);
  }
  return { vertices: [...vertices.values()], edges: [...edges.values()] };
}

/** Returns all pairs of a publisher and another subscriber. */
function pairsOf(publishers: readonly string[], subscribers: readonly string[]): (readonly [string, string])[] {
  return publishers.flatMap((from) => subscribers.filter((to) => to !== from).map((to) => [from, to] as const));
}

interface JoinedTopic extends Pick<GraphTopic, "name" | "publishers" | "subscribers"> {
  action: boolean;
}

/** Returns the topics that pass the filters; the topics of an action are merged into one. */
function topicsOf(graph: NodeGraph, options: GraphOptions): JoinedTopic[] {
  const joined = new Map<string, JoinedTopic>();
  for (const { name, publishers, subscribers } of graph.topics) {
    if (!options.debug && DEBUG_TOPICS.has(name)) continue;
    if (!options.tf && TF_TOPICS.has(name)) continue;
    const at = name.indexOf(ACTION);
    const shown = at < 0 ? name : name.slice(0, at);
    const known = joined.get(shown);
    if (known) {
      known.publishers = [...new Set([...known.publishers, ...publishers])];
      known.subscribers = [...new Set([...known.subscribers, ...subscribers])];
    } else joined.set(shown, { name: shown, publishers, subscribers, action: at >= 0 });
  }
  return [...joined.values()];
}

function ownerOf(node: string, { grouped, openGroups }: GraphOptions): GraphVertex {
  const namespace = node.slice(0, node.indexOf("/", 1));
  if (grouped && node.indexOf("/", 1) > 0 && !openGroups.has(namespace)) {
    return { id: `group:${namespace}`, kind: "group", label: `${namespace}/`, count: 1 };
  }
  return { id: `node:${node}`, kind: "node", label: node, count: 1 };
}
