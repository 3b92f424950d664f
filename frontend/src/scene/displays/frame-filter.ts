/** TF's two filters: regular expressions; a frame must match the first and not the second. Empty ones do nothing. */
export class FrameFilter {
  private readonly wanted: RegExp | null;
  private readonly unwanted: RegExp | null;

  constructor(whitelist: string, blacklist: string) {
    this.wanted = compiled(whitelist);
    this.unwanted = compiled(blacklist);
  }

  accepts(frame: string): boolean {
    return (this.wanted?.test(frame) ?? true) && !(this.unwanted?.test(frame) ?? false);
  }
}

/** A filter that is no regular expression (yet: it is being typed) does nothing. */
function compiled(pattern: string): RegExp | null {
  if (pattern === "") return null;
  try {
    return new RegExp(pattern);
  } catch {
    return null;
  }
}
