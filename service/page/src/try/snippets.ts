// One fit of one picture as programs ask for it: what this page sends itself.

export interface Asked {
  /** Where the service is, as this browser reaches it. */
  readonly origin: string;
  readonly name: string;
  /** Whether the service has the picture among its samples. */
  readonly isSample: boolean;
  readonly request: string;
  /** Whether the service wants a key: snippets read it from the environment. */
  readonly hasKey: boolean;
}

export type Language = "curl" | "fetch" | "python";

/** Each prints the fit's result as JSON. */
export const SNIPPETS: Readonly<Record<Language, (asked: Asked) => string>> = {
  curl: ({ origin, name, isSample, request, hasKey }) => {
    const curl = `curl -sf${hasKey ? ' -H "Authorization: Bearer $MAQUETTE_API_KEY"' : ""}`;
    // In curl's own quotes a name may hold its separators.
    const file = isSample ? name : `"${name.replace(/["\\]/g, "\\$&")}"`;
    return `${isSample ? `curl -sfO ${origin}/page/${name}\n` : ""}FIT=$(${curl} -H 'Prefer: wait=60' \\
  -F ${quoted(`image=@${file}`)} \\
  -F ${quoted(`request=${request}`)} \\
  -o /dev/null -w '%header{location}' ${origin}/v1/fits)
${curl} ${origin}$FIT/result`;
  },

  fetch: ({ origin, name, isSample, request, hasKey }) => `const { openAsBlob } = await import("node:fs");
const service = "${origin}";
const picture = await ${isSample ? `(await fetch(service + "/page/${name}")).blob()` : `openAsBlob(${JSON.stringify(name)})`};
const headers = { Prefer: "wait=60"${hasKey ? ", Authorization: `Bearer ${process.env.MAQUETTE_API_KEY}`" : ""} };

const body = new FormData();
body.append("image", picture);
body.append("request", JSON.stringify(${request}));
const answer = await fetch(service + "/v1/fits", { method: "POST", headers, body });
const fit = await answer.json();
if (fit.state !== "succeeded") throw new Error(JSON.stringify(fit));
const result = await fetch(service + fit.links.result, { headers });
console.log(await result.text());`.replace(isSample ? /^.*\n/ : "", ""),

  python: ({ origin, name, isSample, request, hasKey }) => `${hasKey ? "import os\n\n" : ""}import httpx

service = "${origin}"
picture = ${isSample ? `httpx.get(service + "/page/${name}").content` : `open(${JSON.stringify(name)}, "rb").read()`}
headers = {"Prefer": "wait=60"${hasKey ? ', "Authorization": "Bearer " + os.environ["MAQUETTE_API_KEY"]' : ""}}

with httpx.Client(base_url=service, headers=headers, timeout=90) as client:
    data = {"request": r'''${request}'''}
    answer = client.post("/v1/fits", files={"image": picture}, data=data)
    fit = answer.raise_for_status().json()
    print(client.get(fit["links"]["result"]).raise_for_status().text)`,
};

/** For a shell, as one word. */
function quoted(word: string): string {
  return `'${word.replaceAll("'", "'\\''")}'`;
}
