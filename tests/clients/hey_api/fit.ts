// Fits a picture through the generated client and prints what it measured: node fit.js SERVICE PICTURE
import { openAsBlob } from "node:fs";
import { eraseFit, eraseImage, getFit, getFitResult, submitFit, uploadImage } from "./client/index.js";
import { client } from "./client/client.gen.js";

const [service = "", picture = ""] = process.argv.slice(2);
client.setConfig({ baseUrl: service });
const always = { throwOnError: true } as const;

const { data: image } = await uploadImage({ ...always, body: { image: await openAsBlob(picture) } });
let { data: fit } = await submitFit({ ...always, body: { request: { gender: "male", height_m: 1.804, views: [{ image_id: image.id }] } } });
const path = { fit_id: fit.id };
while (fit.state === "queued" || fit.state === "running") {
  await new Promise((resume) => setTimeout(resume, 300));
  ({ data: fit } = await getFit({ ...always, path }));
}
if (fit.state !== "succeeded") throw new Error(fit.problem?.detail ?? fit.state);
const { data } = await getFitResult({ ...always, path });
const erased = [await eraseFit({ ...always, path }), await eraseImage({ ...always, path: { image_id: image.id } })];
console.log(
  JSON.stringify({
    measurements: Object.fromEntries(data.measurements.map(({ name, value }) => [name, value])),
    erased: erased.map(({ response }) => response.status),
  }),
);
