# The Cornell box with a camera that walks in, in one second: for `make figures`.  The buffer holds 2
# times and 2 places.
/"byteOffset": 168/s/$/,\
    {"bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},\
    {"bufferView": 3, "componentType": 5126, "count": 2, "type": "VEC3"}/
/"byteOffset": 912/s/$/,\
    {"buffer": 1, "byteOffset": 0, "byteLength": 8},\
    {"buffer": 1, "byteOffset": 8, "byteLength": 24}/
s|"byteLength": 1140}\]|"byteLength": 1140},\
    {"byteLength": 32, "uri": "data:application/octet-stream;base64,AAAAAAAAgD8EVo4+qMaLPs3MTL+PwvU9w/WoPs3MzL4="}],\
  "animations": [{"samplers": [{"input": 16, "output": 17, "interpolation": "LINEAR"}],\
    "channels": [{"sampler": 0, "target": {"node": 8, "path": "translation"}}]}]|
