import type { GraphTopic, NodeGraph } from "../../protocol";

export type GraphMode = "nodes" | "active" | "all";

export interface GraphOptions {
  /** Show nodes only, topics that connect nodes, or all topics. */
  mode: GraphMode;
  /** Whether to show topics that every node has. */
  showsDebug: boolean;
  showsTf: boolean;
  /** Whether the nodes of a namespace are one vertex, unless its group is open. */
  groupsNamespaces: boolean;
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
  source: string;
  target: string;
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
const ACTION_NAMESPACE = "/_action/";

/** Returns the vertices and edges to draw for a graph. */
export function buildGraph(graph: NodeGraph, options: GraphOptions): DrawnGraph {
  const vertices = new Map<string, GraphVertex>();
  const nodes = graph.nodes.filter((name) => options.showsDebug || !DEBUG_NODES.test(name));
  const nodeVertices = new Map(nodes.map((name) => [name, vertexOf(name, options)]));
  for (const nodeVertex of nodeVertices.values()) {
    const vertex = vertices.get(nodeVertex.id);
    if (vertex) vertex.count++;
    else vertices.set(nodeVertex.id, { ...nodeVertex });
  }
  const edges = new Map<string, GraphEdge>();
  const connect = (source: string, target: string, topics: string[]): void => {
    const key = `${source}\n${target}`;
    const edge = edges.get(key);
    if (!edge) edges.set(key, { source, target, topics });
    else edge.topics = [...new Set([...edge.topics, ...topics])];
  };
  const vertexIdsOf = (names: readonly string[]): string[] => [
    ...new Set(names.map((name) => nodeVertices.get(name)?.id).filter((id) => id !== undefined)),
  ];
  for (const topic of listShownTopics(graph, options)) {
    const [publishers, subscribers] = [vertexIdsOf(topic.publishers), vertexIdsOf(topic.subscribers)];
    if (options.mode !== "all" && (publishers.length === 0 || subscribers.length === 0)) continue;
    const [firstId, ...otherIds] = new Set([...publishers, ...subscribers]);
    // Topics within a closed group are not shown.
    if (otherIds.length === 0 && vertices.get(firstId ?? "")?.kind === "group") continue;
    if (options.mode === "nodes") {
      for (const [source, target] of listPairs(publishers, subscribers)) connect(source, target, [topic.name]);
      continue;
    }
    const id = `topic:${topic.name}`;
    vertices.set(id, { id, kind: topic.isAction ? "action" : "topic", label: topic.name, count: 0 });
    for (const source of publishers) connect(source, id, []);
    for (const target of subscribers) connect(id, target, []);
  }
  return { vertices: [...vertices.values()], edges: [...edges.values()] };
}

/** Returns all pairs of a publisher and another subscriber. */
function listPairs(publishers: readonly string[], subscribers: readonly string[]): (readonly [string, string])[] {
  return publishers.flatMap((source) => subscribers.filter((target) => target !== source).map((target) => [source, target] as const));
}

interface MergedTopic extends Pick<GraphTopic, "name" | "publishers" | "subscribers"> {
  isAction: boolean;
}

/** Returns the topics that pass the filters; the topics of an action are merged into one. */
function listShownTopics(graph: NodeGraph, options: GraphOptions): MergedTopic[] {
  const mergedTopics = new Map<string, MergedTopic>();
  for (const { name, publishers, subscribers } of graph.topics) {
    if (!options.showsDebug && DEBUG_TOPICS.has(name)) continue;
    if (!options.showsTf && TF_TOPICS.has(name)) continue;
    const index = name.indexOf(ACTION_NAMESPACE);
    const shownName = index < 0 ? name : name.slice(0, index);
    const topic = mergedTopics.get(shownName);
    if (topic) {
      topic.publishers = [...new Set([...topic.publishers, ...publishers])];
      topic.subscribers = [...new Set([...topic.subscribers, ...subscribers])];
    } else mergedTopics.set(shownName, { name: shownName, publishers, subscribers, isAction: index >= 0 });
  }
  return [...mergedTopics.values()];
}

function vertexOf(node: string, { groupsNamespaces, openGroups }: GraphOptions): GraphVertex {
  const namespace = node.slice(0, node.indexOf("/", 1));
  if (groupsNamespaces && node.indexOf("/", 1) > 0 && !openGroups.has(namespace)) {
    return { id: `group:${namespace}`, kind: "group", label: `${namespace}/`, count: 1 };
  }
  return { id: `node:${node}`, kind: "node", label: node, count: 1 };
}
