/* linkage.h: C linkage for the declarations of headers that C++ programs include, too. */
#ifndef WH_LINKAGE_H
#define WH_LINKAGE_H

#ifdef __cplusplus
#define WH_C_BEGIN extern "C" {
#define WH_C_END }
#else
#define WH_C_BEGIN
#define WH_C_END
#endif

#endif
