// Measures the sample pair through the generated client and prints what came of it as JSON.
// node scan.js SERVICE FRONT SIDE REQUEST, once with pictures in the form, once uploaded before.
import { readFile } from "node:fs/promises";
import { basename } from "node:path";
import createClient from "openapi-fetch";
import type { components, paths } from "./schema.js";

const [service, ...files] = process.argv.slice(2) as [string, string, string, string];
const pictures = files.slice(0, 2);
const { GET, POST, DELETE } = createClient<paths>({ baseUrl: service });

function told<T>(data: T | undefined, error: components["schemas"]["Problem"] | undefined): T {
  if (data === undefined) throw new Error(error?.detail ?? "no answer");
  return data;
}

type Scan = components["schemas"]["Scan"];
type View = components["schemas"]["ViewKind"];
interface Found {
  measurements: Record<string, number>;
  views: View[];
}

const asked = JSON.parse(await readFile(files[2] as string, "utf8")) as components["schemas"]["ScanRequest"];
const images = await Promise.all(
  pictures.map(async (file) => new Blob([new Uint8Array(await readFile(file))], { type: "image/jpeg" })),
);

async function submittedAsForm(): Promise<Scan> {
  const { data, error } = await POST("/v1/scans", {
    body: { image_0: "front", image_1: "side", request: asked },
    bodySerializer: () => {
      const form = new FormData();
      images.forEach((image, number) => form.append(`image_${number}`, image, basename(pictures[number] as string)));
      form.append("request", JSON.stringify(asked));
      return form;
    },
  });
  return told(data, error);
}

async function submittedAsJson(ids: string[]): Promise<Scan> {
  const views = asked.views.map((view, number) => ({ ...view, image_id: ids[number] as string }));
  const { data, error } = await POST("/v1/scans", { body: { ...asked, views } });
  return told(data, error);
}

async function uploaded(image: Blob): Promise<string> {
  const { data, error } = await POST("/v1/images", {
    body: { image: "picture" },
    bodySerializer: () => {
      const form = new FormData();
      form.append("image", image, "picture.jpg");
      return form;
    },
  });
  return told(data, error).id;
}

async function found(scan: Scan): Promise<Found> {
  const path = { scan_id: scan.id };
  while (scan.state === "queued" || scan.state === "running") {
    await new Promise((resume) => setTimeout(resume, 300));
    const { data, error } = await GET("/v1/scans/{scan_id}", { params: { path } });
    scan = told(data, error);
  }
  if (scan.state !== "succeeded") throw new Error(scan.problem?.detail ?? scan.state);
  const { data, error } = await GET("/v1/scans/{scan_id}/result", { params: { path } });
  const { measurements, views } = told(data, error);
  return {
    measurements: Object.fromEntries(measurements.map(({ name, value }) => [name, value])),
    views: views.map(({ view }) => view),
  };
}

const ids = [await uploaded(images[0] as Blob), await uploaded(images[1] as Blob)];
const scans = [await submittedAsForm(), await submittedAsJson(ids)] as const;
const results = [await found(scans[0]), await found(scans[1])] as const;
const path = { scan_id: scans[0].id };
const file = await GET("/v1/scans/{scan_id}/artifacts/{name}", {
  params: { path: { ...path, name: "body_posed_1.glb" } },
  parseAs: "arrayBuffer",
});
const glb = new Uint8Array(told(file.data, file.error) as ArrayBuffer);
const followed = await GET("/v1/scans/{scan_id}/events", { params: { path }, parseAs: "text" });
const events: string = told(followed.data, followed.error);
const erased: number[] = [];
for (const { id } of scans) {
  const { response } = await DELETE("/v1/scans/{scan_id}", { params: { path: { scan_id: id } } });
  erased.push(response.status);
}
for (const image_id of ids) {
  const { response } = await DELETE("/v1/images/{image_id}", { params: { path: { image_id } } });
  erased.push(response.status);
}
console.log(
  JSON.stringify({
    measurements: results.map(({ measurements }) => measurements),
    views: results[0].views,
    glb: new TextDecoder().decode(glb.slice(0, 4)),
    ends: events.split("event: end").length - 1,
    erased,
  }),
);

// @ts-expect-error there is no such view
if (asked.views[0]?.view === "above") throw new Error();
