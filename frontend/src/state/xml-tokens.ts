/** The kind of a token of XML text, which determines its color. */
type TokenKind = "text" | "tag" | "attribute" | "value" | "expression" | "comment" | "punctuation";

export interface Token {
  readonly kind: TokenKind;
  readonly text: string;
}

/** The construct within which a line begins. */
export type LineState = "text" | "tag" | "comment" | "cdata" | "instruction" | '"' | "'";

/** Constructs that may span lines, with their ends and their openings. */
const END_MARKERS: Readonly<Partial<Record<LineState, string>>> = { comment: "-->", cdata: "]]>", instruction: "?>" };
const OPENING_MARKERS: readonly (readonly [string, LineState])[] = [
  ["<!--", "comment"],
  ["<![CDATA[", "cdata"],
  ["<?", "instruction"],
];
const TAG_PART = /^(?:\s+|\/?>|[^\s=/>"'<]+|=|["']|.)/u;
/** A xacro expression or substitution in a value. */
const EXPRESSION = /\$\$?(?:\{[^}]*\}?|\([^)]*\)?)/g;

/** A line that consists of text and complete tags only, as most do, and therefore ends as it began. */
const PLAIN_LINE = /^[^<]*(?:<[^<>"'!?]*(?:"[^"<>]*"[^<>"']*)*>[^<]*)*$/;

/**
 * Returns the tokens of a line that begins in `state`, and the state of the next line. The tokens concatenated are the
 * line.
 */
export function tokenize(line: string, state: LineState): { tokens: Token[]; state: LineState } {
  const scanner = new Scanner(line, state);
  scanner.run();
  return { tokens: scanner.tokens, state: scanner.state };
}

/** Returns the state at the beginning of each line. */
export function computeLineStates(lines: readonly string[]): LineState[] {
  let state: LineState = "text";
  return lines.map((line) => {
    const startState = state;
    if (state !== "text" || !PLAIN_LINE.test(line)) state = tokenize(line, state).state;
    return startState;
  });
}

/** Reads a line. Each step consumes at least one character, or changes the state. */
class Scanner {
  readonly tokens: Token[] = [];
  private expectsName = false;

  constructor(
    private remainingText: string,
    public state: LineState,
  ) {}

  run(): void {
    while (this.remainingText !== "") {
      const end = END_MARKERS[this.state];
      if (end !== undefined) this.readUntil(end);
      else if (this.state === '"' || this.state === "'") this.readValue(this.state);
      else if (this.state === "tag") this.readTagPart();
      else this.readText();
    }
  }

  private readUntil(end: string): void {
    const index = this.remainingText.indexOf(end);
    const kind = this.state === "cdata" ? "text" : "comment";
    this.push(kind, index < 0 ? this.remainingText.length : index + end.length);
    if (index >= 0) this.state = "text";
  }

  private readValue(quote: string): void {
    const index = this.remainingText.indexOf(quote);
    this.pushMixed("value", index < 0 ? this.remainingText.length : index);
    if (index < 0) return;
    this.push("value", 1);
    this.state = "tag";
  }

  private readTagPart(): void {
    const part = TAG_PART.exec(this.remainingText)?.[0] ?? this.remainingText;
    if (part === '"' || part === "'") {
      this.push("value", 1);
      this.state = part;
    } else if (part === "=" || part === "/" || part.endsWith(">") || /^\s/.test(part)) {
      this.push("punctuation", part.length);
      if (part.endsWith(">")) this.state = "text";
    } else {
      this.push(this.expectsName ? "tag" : "attribute", part.length);
      this.expectsName = false;
    }
  }

  private readText(): void {
    const index = this.remainingText.indexOf("<");
    this.pushMixed("text", index < 0 ? this.remainingText.length : index);
    if (index < 0) return;
    const opening = OPENING_MARKERS.find(([text]) => this.remainingText.startsWith(text));
    if (opening) {
      this.state = opening[1];
      return;
    }
    this.push("punctuation", /^<[/!]/.test(this.remainingText) ? 2 : 1);
    this.state = "tag";
    this.expectsName = true;
  }

  /** Consumes text that may contain expressions. */
  private pushMixed(kind: TokenKind, length: number): void {
    let prefixLength = 0;
    for (const match of this.remainingText.slice(0, length).matchAll(EXPRESSION)) {
      this.push(kind, match.index - prefixLength);
      this.push("expression", match[0].length);
      prefixLength = match.index + match[0].length;
    }
    this.push(kind, length - prefixLength);
  }

  private push(kind: TokenKind, length: number): void {
    if (length > 0) this.tokens.push({ kind, text: this.remainingText.slice(0, length) });
    this.remainingText = this.remainingText.slice(length);
  }
}
