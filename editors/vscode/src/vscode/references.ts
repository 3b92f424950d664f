import { commands, Location, Position, Range, Uri } from "vscode";

/** The command of the code lens that counts the uses of a name. */
export const SHOW_REFERENCES = "linkwright.showReferences";

interface ProtocolPosition {
  readonly line: number;
  readonly character: number;
}

interface ProtocolLocation {
  readonly uri: string;
  readonly range: { readonly start: ProtocolPosition; readonly end: ProtocolPosition };
}

/** Show locations from the language server in VS Code's list of references. */
export async function showReferences(
  uri: string,
  position: ProtocolPosition,
  locations: readonly ProtocolLocation[],
): Promise<void> {
  await commands.executeCommand(
    "editor.action.showReferences",
    Uri.parse(uri, true),
    toPosition(position),
    locations.map(({ uri: file, range }) => new Location(Uri.parse(file, true), toRange(range))),
  );
}

function toRange({ start, end }: ProtocolLocation["range"]): Range {
  return new Range(toPosition(start), toPosition(end));
}

function toPosition({ line, character }: ProtocolPosition): Position {
  return new Position(line, character);
}
