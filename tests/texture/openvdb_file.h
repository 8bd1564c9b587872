#pragma once

namespace turbid::testing {

/// A file written by OpenVDB 10.0 (blosc, active-mask compression), in gzip and base64: "density" (12 voxels
/// (i, 2i, -i) = 1 + i and 8^3 voxels from (16, 16, 16) = 2.5, transform scale 0.25), "temperature" (background 300;
/// (1, 2, 3) = 1500, (-1, -2, -3) = 900; in half; scale (0.5, 0.25, 0.125), a quarter turn about z, translation
/// (1, 2, 3)) and "color" ((0, 0, 0) = (0.1, 0.2, 0.3), scale 2).
inline constexpr const char* kOpenVdbFile =
    "H4sIAAAAAAACA+3dT0/bZhzAcTujJStsZFO7ShWafKjWSRVSaNKqVF0x2zT10O7S0VNVy06ebJYcm8YmBWmH9E1Uoqee+jbKC4AJ"
    "7bwDL4HLjmv6PNgOxhBIFYIE+36kh9+Th+dP/Dg8uVg/jB9/fqpJ27Jc0mJ6Y656x3HKd2fqouLMVJ2ymLHLc87MrVuzs478TXW2"
    "eld1/EyWcVnqwg/daLUkq7+1hLAaXmBH1m2ralVUtz+Tee89iuONX+N4MRn+hSwN1xOW4wQrVtNeuSAb2qJWcSdl5Wqm5Hq6/r6e"
    "qX+73W4p7VkLmkstEYZu4Kv1wqjl+r9fkTXHC8KacdOwa5HbFkbb9pZF+FU6rC48e1XULXkldbWqlbaohjnZcEHLuZ7E73Ovp3Px"
    "y3SJpmhazmokQjWV60d3qkU1/OXnu916F9AOVoQnL2PZj/Z1nCzE843J4ttNsXd1mVsyJauLvtsIWs0nNdsTj+2leNTW/KfFknl4"
    "LPeJ2oGoZ/aqkN24nW5X/uxoAAAAAAAAAAAAAADgbCslsaBX1PMMmp62dQZ4MGCd/QP+XwdDz975YPZqxomtq2nFXm2sVysMvb5+"
    "gnuk8zEBAAAAAAAAAAAAAODs6/eQBA8GYFhjbMHZdTlzMIwlNzNuM8yTOxw6vZrZqxnHD5vOvDmVvmtyr03OY8rSMQc9+fo+pmVk"
    "FiklA+K2t3LydVm21SILI7waQ05elsVc0Ed3P0ujnLwzPyF/RqK5JFp2tNwS17SDmd6sh7bX+EW9VkOWkhxv02tx/DuJF5NbdXTO"
    "Nz2+ebsJ5o7O+daVPsjy36hzvn2r5dKWaddy8ZjEbsXnAyZ2S1f5RjWGVmi35XuyQ+sPub/xhqs74wSBp7ZJP5j/LXez1LILjYbr"
    "q+xv488uV7579+p+vESa3S1v+33c78X9wT4667l5dub3/wkVzbQ9/pS+/klLL1Rlf0sLAAAAAAA47zpsAQAAAAAAwPnWYQswBGPf"
    "Kx5+BgAAAAAAAAAAAADgHOABAABaNjnY6TE07eukqjJqFZITSbUVa0O/tX5T/yNULqla4AUtlWhqN0mXSpYVxkm61JCJN/FQdz2O"
    "fyVRJZAa145LzZV1dGqurJGm5rqSP+yvJ/GYjFxvFwbMyJVOfjDVVm+zp2Rl0XcbQav5pGZ7KtVWMsj8tLg9f3jcGjjqA3wX8t0I"
    "AAAAAAAAAAAAAMA5wL8MBXBqB8PQB0u/f7C5ubHxw+bGowdv1tYefARX0GB6zsAAAA==";

}  // namespace turbid::testing
