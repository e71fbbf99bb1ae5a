// Fits the sample through the generated client and prints what came of it as JSON.
// node fit.js SERVICE PICTURE REQUEST
import { readFile } from "node:fs/promises";
import { basename } from "node:path";
import createClient from "openapi-fetch";
import type { components, paths } from "./schema.js";

const [service, picture, request] = process.argv.slice(2) as [string, string, string];
const { GET, POST, DELETE } = createClient<paths>({ baseUrl: service });

function told<T>(data: T | undefined, error: components["schemas"]["Problem"] | undefined): T {
  if (data === undefined) throw new Error(error?.detail ?? "no answer");
  return data;
}

const image = new Blob([new Uint8Array(await readFile(picture))], { type: "image/jpeg" });
const asked = JSON.parse(await readFile(request, "utf8")) as components["schemas"]["FitRequest"];
const posted = await POST("/v1/fits", {
  body: { image: basename(picture), request: asked },
  bodySerializer: () => {
    const form = new FormData();
    form.append("image", image, basename(picture));
    form.append("request", JSON.stringify(asked));
    return form;
  },
});
let job = told(posted.data, posted.error);
const path = { fit_id: job.id };
while (job.state === "queued" || job.state === "running") {
  await new Promise((resume) => setTimeout(resume, 300));
  const { data, error } = await GET("/v1/fits/{fit_id}", { params: { path } });
  job = told(data, error);
}
if (job.state !== "succeeded") throw new Error(job.problem?.detail ?? job.state);

const { data, error } = await GET("/v1/fits/{fit_id}/result", { params: { path } });
const { measurements } = told(data, error);
const file = await GET("/v1/fits/{fit_id}/artifacts/{name}", {
  params: { path: { ...path, name: "body_posed.glb" } },
  parseAs: "arrayBuffer",
});
const glb = new Uint8Array(told(file.data, file.error) as ArrayBuffer);
const erased = await DELETE("/v1/fits/{fit_id}", { params: { path } });
console.log(
  JSON.stringify({
    measurements: Object.fromEntries(measurements.map(({ name, value }) => [name, value])),
    glb: new TextDecoder().decode(glb.slice(0, 4)),
    erased: erased.response.status,
  }),
);

// The types are those of the document, not `any`: each of these must be an error.
// @ts-expect-error there is no such state
if (job.state === "finished") throw new Error();
// @ts-expect-error there is no such path
export const elsewhere = () => GET("/v1/fit");
// @ts-expect-error a gender is needed
export const nobody: components["schemas"]["BodyRequest"] = {};
