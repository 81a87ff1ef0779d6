// What this firmware is called: the project's version (CMakeLists.txt; a test holds the two together) and that of the
// link's records.

#ifndef STILLSPIN_FIRMWARE_DICTIONARY_VERSION_H
#define STILLSPIN_FIRMWARE_DICTIONARY_VERSION_H

#define FIRMWARE_VERSION "0.1.0"
#define FIRMWARE_NAME "stillspin " FIRMWARE_VERSION
#define LINK_PROTOCOL 1u  // of the records: raised when a record that exists changes

#endif
