// Prints Khronos' validation report of the GLB on standard input as JSON.
import { validateBytes } from 'gltf-validator';

const chunks = [];
for await (const chunk of process.stdin) chunks.push(chunk);
const report = await validateBytes(new Uint8Array(Buffer.concat(chunks)), { maxIssues: 50 });
console.log(JSON.stringify(report));
